"""A first guess of how an unknown robot stands: with bent knees, last links down, belly well over the ground."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.robots.description import RobotDescription
from weaver_shared.robots.plausibility import REACHED
from weaver_shared.robots.reach import joints_reaching, leg_length

Array = NDArray[np.float64]

SAMPLES = 6000
DRAWN_IN = 0.12
"""Of a joint's range, kept free at both ends."""
LOWEST, HIGHEST = 0.35, 0.9
"""Of the leg's length, that a foot may be under its hip."""
GAP = 0.12
"""Of the leg's length, at least between belly and ground, and from the ground up to every joint but the last."""
APART = 0.25
"""Of the leg's length, at least between two feet."""
OUTSIDE = 0.05
"""Of the leg's length, that the mass must be inside the feet."""
SITTING_GAPS = (0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
"""Of the height between ground and belly when standing."""


def standing_guess(robot: RobotDescription, seed: int = 0) -> tuple[Array, Array]:
    """Joint angles (n,) and feet (legs, 3) m in body; raises InputError where no angles that were tried will do."""
    rng, (lower, upper) = np.random.default_rng(seed), robot.joint_limits.T
    span = np.minimum(upper - lower, 2.0 * np.pi)
    within = rng.uniform(DRAWN_IN, 1.0 - DRAWN_IN, size=(SAMPLES, len(lower)))
    places = _places(robot, lower + span * within)
    scores = _scores(robot, places, within)
    best = int(scores.argmax())
    if not np.isfinite(scores[best]):
        raise InputError(
            f"robot {robot.name!r}: no way to stand was found among {SAMPLES} angles of its legs within their limits; "
            "valid are legs that reach well below the trunk, with all feet around its mass"
        )
    angles, feet = lower + span * within[best], places[best, :, -1]
    level = feet.copy()
    level[:, 2] = feet[:, 2].mean()
    found, left = joints_reaching(robot, level, np.tile(angles, (robot.leg_count, 1)))
    if float(left.max()) > REACHED * leg_length(robot):
        raise InputError(
            f"robot {robot.name!r}: leg {robot.leg_names[int(np.argmax(left))]} can not stand as the others do; valid "
            "are legs that reach the same ground"
        )
    return found[0], level


def sitting_gap(robot: RobotDescription) -> float:
    """m between belly and ground of the lowest place, over the same feet, that the legs allow."""
    height = robot.clearance + robot.belly
    for share in SITTING_GAPS:
        feet = robot.stance_in_body.copy()
        feet[:, 2] = robot.belly - share * height + robot.foot_radius
        _, left = joints_reaching(robot, feet, robot.standing_search, steps=60)
        if float(left.max()) < 0.5 * REACHED * leg_length(robot):
            return share * height
    return max(height, 0.0)


def _places(robot: RobotDescription, angles: Array) -> Array:
    """Hip, joints and foot in body of all legs at the same `angles` (samples, n): (samples, legs, n + 1, 3) m."""
    turned, at = np.tile(np.eye(3), (len(angles), 1, 1)), np.zeros((len(angles), 3))
    points = [at]
    for (theta, d, r, alpha), angle in zip(robot.dh, angles.T, strict=True):
        c, s = np.cos(theta + angle), np.sin(theta + angle)
        ca, sa, zero = np.full_like(c, np.cos(alpha)), np.full_like(c, np.sin(alpha)), np.zeros_like(c)
        step = np.array([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [zero, sa, ca]]).transpose(2, 0, 1)
        at = at + (turned @ np.stack([r * c, r * s, np.full_like(c, d)], axis=1)[:, :, None])[:, :, 0]
        turned = turned @ step
        points.append(at)
    chain = np.stack(points, axis=1)
    places: Array = robot.hips_in_body[None, :, None] + np.einsum("lij,spj->slpi", robot.hip_axes, chain)
    return places


def _scores(robot: RobotDescription, places: Array, within: Array) -> Array:
    """How well a robot stands with its legs so, (samples,); minus infinity where it does not."""
    size, feet = leg_length(robot), places[:, :, -1]
    drop = (robot.hips_in_body[:, 2] - feet[:, :, 2]).mean(axis=1) / size
    ground = feet[:, :, 2].mean(axis=1)
    stands = (drop > LOWEST) & (drop < HIGHEST) & (robot.belly - ground > GAP * size) & (ground < -GAP * size)
    stands &= (places[:, :, 1:-2, 2] - feet[:, :, None, 2]).min(axis=(1, 2)) > GAP * size
    between = np.linalg.norm(feet[:, :, None] - feet[:, None], axis=3) + size * np.eye(robot.leg_count)
    stands &= between.min(axis=(1, 2)) > APART * size
    stands &= _inside(robot, feet) > OUTSIDE * size
    last = places[:, :, -1] - places[:, :, -2]
    upright = (-last[..., 2] / np.maximum(np.linalg.norm(last, axis=2), 1e-9)).mean(axis=1)
    out = np.linalg.norm((feet - robot.hips_in_body)[..., :2], axis=2).mean(axis=1) / size
    free = (1.0 - np.abs(2.0 * within - 1.0)).min(axis=1)
    return np.where(stands, upright + free - 2.0 * np.abs(drop - 0.62) - np.abs(out - 0.35), -np.inf)


def _inside(robot: RobotDescription, feet: Array) -> Array:
    """Least way (m) of the trunk's mass to an edge between neighbouring `feet` (samples, legs, 3), (samples,)."""
    around = feet[..., :2] - np.asarray(robot.body.centre_of_mass_in_body)[:2]
    order = np.argsort(np.arctan2(around[..., 1], around[..., 0]), axis=1)
    around = np.take_along_axis(around, order[..., None], axis=1)
    edges = np.roll(around, -1, axis=1) - around
    lengths = np.maximum(np.linalg.norm(edges, axis=2), 1e-9)
    ways = (edges[..., 1] * around[..., 0] - edges[..., 0] * around[..., 1]) / lengths
    least: Array = ways.min(axis=1)
    return least
