"""Body posture: height over the measured feet, attitude between gravity and ground, mass over the support.

The answer is a twist of the body against its standing feet; integrated by the walker it also takes up servo sag,
because height and attitude are measured, not assumed (inclination control of ICRA'17 III-C).
"""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def wanted_up(up: Array, plane: Array, follow_ground: float, result: Array) -> None:
    """Fill `result` (3,) with the direction in body its z axis should point at: between gravity's up and the normal."""
    norm = sqrt(plane[0] ** 2 + plane[1] ** 2 + 1.0)
    normal = (-plane[0] / norm, -plane[1] / norm, 1.0 / norm)
    length = 0.0
    for k in range(3):
        result[k] = (1.0 - follow_ground) * up[k] + follow_ground * normal[k]
        length += result[k] ** 2
    for k in range(3):
        result[k] /= sqrt(length)


@kernel
def attitude_rate(wanted: Array, gain: float, limit: float, dead_band: float, rate: Array) -> None:
    """Fill `rate` (2,), roll and pitch rate of the body in rad/s, that turns its z axis towards `wanted` (3,)."""
    error_x, error_y = -wanted[1], wanted[0]
    size = sqrt(error_x**2 + error_y**2)
    if size <= dead_band:
        rate[0], rate[1] = 0.0, 0.0
        return
    speed = min(gain * (size - dead_band), limit)
    rate[0], rate[1] = speed * error_x / size, speed * error_y / size


@kernel
def height_rate(plane: Array, wanted: float, gain: float, limit: float, dead_band: float) -> float:
    """Upward speed, m/s, that brings the body's origin `wanted` m above the plane of the foot centres."""
    height = -plane[2] / sqrt(plane[0] ** 2 + plane[1] ** 2 + 1.0)
    error = wanted - height
    if abs(error) <= dead_band:
        return 0.0
    error -= dead_band if error > 0.0 else -dead_band
    rise: float = min(max(gain * error, -limit), limit)
    return rise


@kernel
def support_shift(up: Array, height: float, fraction: float, largest: float, shift: Array) -> None:
    """Fill `shift` (2,), where the middle of the feet belongs in body so that the mass stands over it.

    `height` m is that of the centre of mass above the feet; on level ground the shift is zero.
    """
    scale = -fraction * height / max(up[2], 0.5)
    shift[0], shift[1] = scale * up[0], scale * up[1]
    size = sqrt(shift[0] ** 2 + shift[1] ** 2)
    if size > largest:
        shift[0] *= largest / size
        shift[1] *= largest / size
