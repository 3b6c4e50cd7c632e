"""All legs of a robot as one chain: how each hangs on the body, and what its joints' angles mean in the URDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.robots.urdf.branches import Branch
from weaver_shared.robots.urdf.chain import angle_between, dh_rows, hips
from weaver_shared.transforms import rotation_exp, rotation_x, rotation_z

Array = NDArray[np.float64]

SAME_LENGTH = 5e-3
"""Of the leg's length, that links of different legs may differ."""
SAME_ANGLE = 2e-3
"""rad, that their axes may differ."""
MIRROR = np.diag([1.0, -1.0, 1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class Mount:
    """Where a leg's chain begins, and its angles: ours = sign * the URDF's + offset (rad)."""

    position: Array  # (3,) m in body
    yaw: float
    roll: float
    mirrored: bool
    signs: Array  # (n,)
    offsets: Array  # (n,) rad
    rows: Array  # (n, 4) of its own

    def limits(self, leg: Branch) -> Array:
        """What the leg's joints allow, (n, 2) rad, in our angles."""
        theirs = np.array([(joint.lower, joint.upper) for joint in leg.joints])
        ours: Array = np.sort(self.signs[:, None] * theirs, axis=1) + self.offsets[:, None]
        return ours

    def strangeness(self, leg: Branch, limits: Array) -> tuple[float, float]:
        """How little its limits are those of the first leg (n, 2), and then how little its angles are the URDF's."""
        own = self.limits(leg)
        apart = float(np.round(np.abs(own - limits).sum(), 3))
        return apart, float((self.signs < 0.0).sum() + np.abs(self.offsets).sum() / np.pi)


def first_mount(leg: Branch) -> Mount:
    """The leg whose table all share: its angles are the URDF's, and its first row turns as little as can be."""
    signs = np.ones(len(leg.axes))
    mounts = [_mount(leg, signs, False, yaw, roll, None) for yaw, roll in hips(leg.axes[0])]
    if len(mounts) == 1:  # a vertical axis: the hip's yaw takes the first row's turn
        turn, roll = float(mounts[0].rows[0, 0]), mounts[0].roll
        mounts = [_mount(leg, signs, False, yaw, roll, None) for yaw in (turn, -turn)]
    return min(mounts, key=lambda mount: abs(float(mount.rows[0, 0])))


def mount_like(leg: Branch, first: Mount, limits: Array, size: float) -> Mount:
    """How a leg with the first one's table hangs; raises InputError for one that has another table.

    Of several ways that with the first leg's `limits` (n, 2) is taken: a leg's angles mean the same for every leg.
    """
    best, least = None, (np.inf, np.inf)
    for mount in _mounts(leg, first):
        if _same(mount.rows, first.rows, size) and (strange := mount.strangeness(leg, limits)) < least:
            best, least = mount, strange
            if max(least) < 1e-6:
                break
    if best is None:
        raise InputError(_unlike(leg, first, size))
    return best


def foot_of(leg: Branch, angles: Array) -> Array:
    """The foot (3,) in body at the URDF's own `angles` (n,) rad, from the lines alone."""
    foot = leg.foot.copy()
    for point, axis, angle in reversed(list(zip(leg.points, leg.axes, angles, strict=True))):
        foot = point + rotation_exp(axis * angle) @ (foot - point)
    return foot


def _unlike(leg: Branch, first: Mount, size: float) -> str:
    """Which joint of a leg is where the first one's is not, read the way in which the least differs."""
    differences = [_differences(mount.rows, first.rows) for mount in _mounts(leg, first)]
    least = min(differences, key=lambda one: float((one / (SAME_LENGTH * size, SAME_LENGTH * size, SAME_ANGLE)).max()))
    index = int((least / (SAME_LENGTH * size, SAME_LENGTH * size, SAME_ANGLE)).max(axis=1).argmax())
    along, across, turn = least[index]
    return (
        f"the leg at joint {leg.joints[0].name!r} is not built as the first one or its mirror image: what follows its "
        f"joint {leg.joints[index].name!r} is {along:.4f} m along and {across:.4f} m across its axis and {turn:.4f} "
        f"rad off; valid is up to {SAME_LENGTH * size:.4f} m and {SAME_ANGLE:g} rad"
    )


def _mounts(leg: Branch, first: Mount) -> Iterator[Mount]:
    """Every way to read the leg: mirrored or not, joints turning one way or the other, hips either way round."""
    count = len(leg.axes)
    for signs in sorted(product((1.0, -1.0), repeat=count), key=lambda one: -sum(one)):
        for mirrored in (False, True):
            side = -1.0 if mirrored else 1.0
            choices = hips(side * signs[0] * leg.axes[0])
            if len(choices) == 1:
                roll = choices[0][1]
                turn = _mount(leg, np.array(signs), mirrored, 0.0, roll, first.rows).rows[0, 0] - first.rows[0, 0]
                choices = [(float(turn), roll), (float(-turn), roll)]
            for yaw, roll in choices:
                yield _mount(leg, np.array(signs), mirrored, yaw, roll, first.rows)


def _mount(leg: Branch, signs: Array, mirrored: bool, yaw: float, roll: float, like: Array | None) -> Mount:
    """The leg's own rows, seen from a hip turned so; with `like`, its hip lies where the first row's d is the same."""
    body_from_hip = rotation_z(yaw) @ rotation_x(roll)
    chain_axes = body_from_hip @ (MIRROR if mirrored else np.eye(3))
    side = -1.0 if mirrored else 1.0
    axes = side * (signs[:, None] * leg.axes) @ chain_axes
    hip = leg.points[0]
    rows = dh_rows((leg.points - hip) @ chain_axes, axes, (leg.foot - hip) @ chain_axes, like)
    offsets = np.zeros(len(rows))
    if like is not None:
        hip = hip + (rows[0, 1] - like[0, 1]) * chain_axes[:, 2]
        rows[0, 1] = like[0, 1]
        offsets = np.array([angle_between(mine, theirs) for mine, theirs in zip(rows[:, 0], like[:, 0], strict=True)])
        offsets[np.abs(offsets) < SAME_ANGLE] = 0.0
    return Mount(
        position=hip,
        yaw=float(angle_between(yaw, 0.0)),
        roll=roll,
        mirrored=mirrored,
        signs=signs,
        offsets=offsets,
        rows=rows,
    )


def _same(mine: Array, theirs: Array, size: float) -> bool:
    return bool((_differences(mine, theirs) < (SAME_LENGTH * size, SAME_LENGTH * size, SAME_ANGLE)).all())


def _differences(mine: Array, theirs: Array) -> Array:
    """Of d, r (m) and alpha (rad), (n, 3)."""
    turns = [abs(angle_between(a, b)) for a, b in zip(mine[:, 3], theirs[:, 3], strict=True)]
    return np.column_stack([np.abs(mine[:, 1:3] - theirs[:, 1:3]), turns])
