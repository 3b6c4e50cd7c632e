"""Walkspace and the speed limits that OpenSHC derives from it (facts 3.4, 3.5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, degrees, inf, radians

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.step_cycle import StepCycle
from robot_agent.locomotion.openshc.workspace import BEARINGS, LARGEST_RADIUS, Radii, Workspace

Array = NDArray[np.float64]


def walkspace(stance: Array, workspaces: Sequence[Workspace], *, overlapping: bool = False) -> Radii:
    """Radius common to all legs standing at `stance` (legs, 2 or 3).

    Each new minimum overwrites the opposite bearing, even with a larger value (D22).
    """
    result = {bearing: LARGEST_RADIUS if overlapping else _half_gap(stance, bearing) for bearing in BEARINGS}
    for space in workspaces:
        for bearing, radius in space.at(0.0).items():
            if radius < result[bearing]:
                result[bearing] = radius
                result[(bearing + 180) % 360] = radius
    result[360] = result[0]
    return result


def _half_gap(stance: Array, bearing: int) -> float:
    """Least distance at which any leg, moving along `bearing`, meets the line half-way to a neighbour."""
    least = LARGEST_RADIUS
    for leg in range(len(stance)):
        for neighbour in ((leg + 1) % len(stance), leg - 1):
            gap = stance[neighbour] - stance[leg]
            difference = abs(int(degrees(atan2(gap[1], gap[0]))) % 360 - bearing)
            if (difference < 90 or difference > 270) and gap.any():
                least = min(least, 0.5 * float(np.linalg.norm(gap)) / cos(radians(difference)))
    return least


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedLimits:
    """By bearing (deg): m/s, rad/s, m/s^2, rad/s^2."""

    linear: Radii
    angular: Radii
    linear_acceleration: Radii
    angular_acceleration: Radii

    @staticmethod
    def of(walk: Radii, cycle: StepCycle, reference_foot: Array) -> SpeedLimits:
        """`reference_foot` (2,) m, of the first leg, alone sets the angular limits (D23)."""
        inside = [cycle.swing_end - o for o in cycle.offsets if cycle.swing_start < o < cycle.swing_end]
        longest = (max(inside, default=0) + cycle.period) * cycle.dt
        turn_radius = float(np.linalg.norm(reference_foot))
        linear = {b: _largest_speed(radius, cycle, longest) for b, radius in walk.items()}
        return SpeedLimits(
            linear=linear,
            angular={b: v / turn_radius for b, v in linear.items()},
            linear_acceleration={b: v / longest if v > 0.0 else inf for b, v in linear.items()},
            angular_acceleration={b: v / turn_radius / longest if v > 0.0 else inf for b, v in linear.items()},
        )


def _largest_speed(radius: float, cycle: StepCycle, longest: float) -> float:
    """Speed whose stance, also the longer first one while speeding up, stays within `radius`."""
    if radius == 0.0:
        return 0.0
    ratio, f = cycle.on_ground_ratio, cycle.frequency
    v0 = 2.0 * radius * f / ratio
    a0 = v0 / longest
    over_stance = 0.0
    for offset in cycle.offsets:
        t = offset * cycle.dt
        vs = a0 * (longest - t)
        d1 = -vs * ratio / (2.0 * f) + vs * t + 0.5 * a0 * t * t
        d2 = v0 * (cycle.stance_period * cycle.dt - t)
        over_stance = max(over_stance, d1 + d2 - radius)
    over_swing = 0.5 * v0 * cycle.swing_period / (2.0 * cycle.period * f)
    scaled = radius * radius / (radius + over_stance + over_swing)
    return 2.0 * scaled * f / ratio


def limit_towards(limits: Radii, tips: Array, linear: Array, angular: float) -> float:
    """Least limit over the legs' own directions. The bearing's lower neighbour counts, not an interpolation (D4)."""
    least = inf
    for tip in tips:
        x, y = linear[0] - angular * tip[1], linear[1] + angular * tip[0]
        turned = degrees(atan2(y, x))
        bearing = (int(turned + 0.5) if turned >= 0.0 else -int(0.5 - turned)) % 360
        least = min(least, limits[bearing - bearing % 45])
    return least
