"""Workspace, walkspace and the speed limits that OpenSHC derives from them (facts 3.4, 3.5)."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, inf, radians, sin

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.step_cycle import StepCycle

Array = NDArray[np.float64]

BEARINGS = tuple(range(0, 361, 45))
STEP = 0.002
LARGEST_RADIUS = 1.0


def workspace(leg: Leg, identity: Array) -> dict[int, float]:
    """Radius (m) by bearing (deg) that the leg reaches about its identity tip (3,), one solver step each 2 mm."""
    radius = {}
    for bearing in BEARINGS[:-1]:
        trial = leg.copy(clamp_rate=False)
        direction = np.array([cos(radians(bearing)), sin(radians(bearing)), 0.0])
        for step in range(1, round(LARGEST_RADIUS / STEP) + 1):
            if trial.step_to(identity + direction * step * STEP) <= 0.0:
                break
        radius[bearing] = float(np.linalg.norm(trial.tip() - identity))
    radius[360] = radius[0]
    return radius


def walkspace(stance: Array, workspaces: list[dict[int, float]]) -> dict[int, float]:
    """Radius common to all legs. Each new minimum overwrites the opposite bearing, even with a larger value."""
    result = {bearing: _half_gap(stance, bearing) for bearing in BEARINGS}
    for radius in workspaces:
        for bearing in BEARINGS:
            if radius[bearing] < result[bearing]:
                result[bearing] = radius[bearing]
                result[(bearing + 180) % 360] = radius[bearing]
    result[360] = result[0]
    return result


def _half_gap(stance: Array, bearing: int) -> float:
    """Least distance at which any leg, moving along `bearing`, meets the line half-way to a neighbour."""
    least = LARGEST_RADIUS
    for leg in range(len(stance)):
        for neighbour in ((leg + 1) % len(stance), leg - 1):
            gap = stance[neighbour] - stance[leg]
            difference = abs(int(degrees(atan2(gap[1], gap[0]))) % 360 - bearing)
            if difference < 90 or difference > 270:
                least = min(least, 0.5 * float(np.linalg.norm(gap)) / cos(radians(difference)))
    return least


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedLimits:
    """By bearing (deg): m/s, rad/s, m/s^2, rad/s^2."""

    linear: dict[int, float]
    angular: dict[int, float]
    linear_acceleration: dict[int, float]
    angular_acceleration: dict[int, float]

    @staticmethod
    def of(walk: dict[int, float], cycle: StepCycle, stance: Array, dt: float) -> SpeedLimits:
        inside = [cycle.swing_end - o for o in cycle.offsets if cycle.swing_start < o < cycle.swing_end]
        longest = (max(inside, default=0) + cycle.period) * dt
        turn_radius = float(np.linalg.norm(stance[0]))
        linear = {b: _largest_speed(radius, cycle, longest, dt) for b, radius in walk.items()}
        return SpeedLimits(
            linear=linear,
            angular={b: v / turn_radius for b, v in linear.items()},
            linear_acceleration={b: v / longest if v > 0.0 else inf for b, v in linear.items()},
            angular_acceleration={b: v / turn_radius / longest if v > 0.0 else inf for b, v in linear.items()},
        )


def _largest_speed(radius: float, cycle: StepCycle, longest: float, dt: float) -> float:
    """Speed whose stance, also the longer first one while speeding up, stays within `radius`."""
    if radius == 0.0:
        return 0.0
    ratio, f = cycle.on_ground_ratio, cycle.frequency
    v0 = 2.0 * radius * f / ratio
    a0 = v0 / longest
    over_stance = 0.0
    for offset in cycle.offsets:
        t = offset * dt
        vs = a0 * (longest - t)
        d1 = -vs * ratio / (2.0 * f) + vs * t + 0.5 * a0 * t * t
        d2 = v0 * (cycle.stance_period * dt - t)
        over_stance = max(over_stance, d1 + d2 - radius)
    over_swing = 0.5 * v0 * cycle.swing_period / (2.0 * cycle.period * f)
    scaled = radius * radius / (radius + over_stance + over_swing)
    return 2.0 * scaled * f / ratio


def limit_towards(limits: dict[int, float], tips: Array, linear: Array, angular: float) -> float:
    """Least limit over the legs' own directions. The bearing's lower neighbour counts, not an interpolation (D4)."""
    least = inf
    for tip in tips:
        x, y = linear[0] - angular * tip[1], linear[1] + angular * tip[0]
        bearing = round(degrees(atan2(y, x))) % 360
        least = min(least, limits[bearing - bearing % 45])
    return least
