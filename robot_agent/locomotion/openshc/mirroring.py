"""Whether one leg's Denavit-Hartenberg rows are another's, or those of its mirror image."""

from __future__ import annotations

from math import pi

from robot_agent.locomotion.openshc.configuration import Leg, Link
from weaver_shared.errors import ConfigurationError

ANGLE, LENGTH = 2e-3, 1e-6
"""rad and m within which rows are the same; OpenSHC rounds quarter turns to 1.571."""


def joint_signs(reference: Leg, leg: Leg) -> list[int]:
    """What a joint of `leg` turns where the reference's turns 1: all 1 where the legs have one chain.

    A mirrored chain begins reflected in y. A row may pass it on, or turn it into a reflection in z, in which joints
    keep their sense. Raises ConfigurationError that names the link.
    """
    if len(leg.links) != len(reference.links):
        raise ConfigurationError(
            f"leg_DOF.{leg.name} is {len(leg.joints)}; valid is {len(reference.joints)}, as {reference.name} has"
        )
    rows = list(zip(reference.links[1:], leg.links[1:], strict=True))
    if all(_is_same(here, there) for here, there in rows):
        return [1] * len(rows)
    signs, in_y = [], True
    for number, (here, there) in enumerate(rows, start=1):
        signs.append(-1 if in_y else 1)
        theta, d = (-here.theta, here.d) if in_y else (here.theta, -here.d)
        kept = abs(_wrapped(there.alpha + here.alpha)) < ANGLE
        changed = abs(_wrapped(there.alpha + here.alpha - pi)) < ANGLE
        same = (
            abs(_wrapped(there.theta - theta)) < ANGLE and abs(there.d - d) < LENGTH and abs(there.r - here.r) < LENGTH
        )
        if not (same and (kept or changed)):
            raise ConfigurationError(
                f"{leg.name}: link {number} ({there}) is neither {reference.name}'s ({here}) nor its mirror image; "
                "valid are legs with one chain"
            )
        in_y = in_y != changed
    return signs


def _is_same(here: Link, there: Link) -> bool:
    turns = (there.theta - here.theta, there.alpha - here.alpha)
    return (
        all(abs(_wrapped(turn)) < ANGLE for turn in turns)
        and abs(there.d - here.d) < LENGTH
        and abs(there.r - here.r) < LENGTH
    )


def _wrapped(angle: float) -> float:
    return (angle + pi) % (2.0 * pi) - pi
