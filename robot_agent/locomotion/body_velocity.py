"""The velocity really walked: within every leg's stride, within the largest speed, and without jumps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.workspace import velocity_scale

Array = NDArray[np.float64]

STILL = 1e-4
"""m/s or rad/s under which a command means stop."""
TURN_RADIUS = 0.4
"""m, about a foot's distance from the middle: weighs turning against translation."""


@kernel
def limit_velocity(
    wanted: Array,
    stance: Array,
    radius: Array,
    duty: float,
    frequency: float,
    largest_stride: float,
    largest_speed: float,
    result: Array,
) -> float:
    """Fill `result` (3,) with `wanted` (vx, vy, turn) shortened to what the legs can do; returns the factor applied."""
    size = np.sqrt(wanted[0] ** 2 + wanted[1] ** 2 + (TURN_RADIUS * wanted[2]) ** 2)
    scale = 1.0 if size <= largest_speed else largest_speed / size
    for k in range(3):
        result[k] = scale * wanted[k]
    further = velocity_scale(result, stance, radius, duty, frequency, largest_stride)
    for k in range(3):
        result[k] *= further
    return scale * further


@kernel
def approach(current: Array, target: Array, speed_up: float, slow_down: float, dt: float) -> None:
    """Move `current` (3,) towards `target` in place, by at most `speed_up` or, when slowing, `slow_down` m/s^2."""
    dx, dy, dw = target[0] - current[0], target[1] - current[1], TURN_RADIUS * (target[2] - current[2])
    gap = np.sqrt(dx * dx + dy * dy + dw * dw)
    now = current[0] ** 2 + current[1] ** 2 + (TURN_RADIUS * current[2]) ** 2
    then = target[0] ** 2 + target[1] ** 2 + (TURN_RADIUS * target[2]) ** 2
    step = (slow_down if then < now else speed_up) * dt
    share = 1.0 if gap <= step else step / gap
    for k in range(3):
        current[k] += share * (target[k] - current[k])


def clean_velocity(wanted: Array) -> tuple[Array, bool]:
    """The command as three finite numbers, zero where it is none or hardly any; and whether it was usable."""
    velocity = np.asarray(wanted, dtype=np.float64).reshape(-1)
    if velocity.size != 3 or not np.isfinite(velocity).all():
        return np.zeros(3), False
    return (velocity if np.abs(velocity).max() > STILL else np.zeros(3)), True
