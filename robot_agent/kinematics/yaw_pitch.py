"""Closed-form inverse kinematics of the three-joint leg: yaw, then two parallel pitch joints (OpenSHC's default leg).

Yaw turns the leg's plane through the foot; femur and tibia are a two-link arm in it. Of the up to four postures that
reach the foot, forwards or over the hip, knee up or down, the one within the limits nearest to the last is taken.
"""

from math import acos, atan2, cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]

STRAIGHT = 0.9999
"""Of the stretched leg, short of the singularity."""


def is_yaw_pitch(dh: Array) -> bool:
    """Whether a chain (n, 4) is yaw, pitch, pitch: the first joint square to the two others, which are parallel."""
    if dh.shape != (3, 4):
        return False
    square = abs(abs(dh[0, 3]) - 0.5 * pi) < 1e-9
    return bool(square and abs(dh[1, 3]) < 1e-9 and dh[1, 2] > 0.0 and dh[2, 2] > 0.0)


@kernel
def solve_yaw_pitch(
    dh: Array,
    limits: Array,
    hip_in_body: Array,
    hip_axes: Array,
    foot_in_body: Array,
    previous: Array,
    solution: Array,
) -> bool:
    """Joints (3,) that put the foot exactly at `foot_in_body` (3,); False, `solution` undefined, where none do."""
    fx, fy, fz = foot_in_body[0] - hip_in_body[0], foot_in_body[1] - hip_in_body[1], foot_in_body[2] - hip_in_body[2]
    x = hip_axes[0, 0] * fx + hip_axes[1, 0] * fy + hip_axes[2, 0] * fz
    y = hip_axes[0, 1] * fx + hip_axes[1, 1] * fy + hip_axes[2, 1] * fz
    z = hip_axes[0, 2] * fx + hip_axes[1, 2] * fy + hip_axes[2, 2] * fz
    turned = 1.0 if dh[0, 3] > 0.0 else -1.0
    beside = -turned * (dh[1, 1] + dh[2, 1])  # the foot's place along the axis that the plane is normal to
    out_squared = x * x + y * y - beside * beside
    if out_squared <= 0.0:
        return False
    upper, lower = dh[1, 2], dh[2, 2]
    found, nearest = False, np.inf
    for side in (1.0, -1.0):
        out = side * sqrt(out_squared)
        yaw = _wrapped(atan2(y, x) - atan2(beside, out) - dh[0, 0])
        u, v = out - dh[0, 2], turned * (z - dh[0, 1])
        squared = u * u + v * v
        if squared > (STRAIGHT * (upper + lower)) ** 2 or squared < (upper - lower) ** 2:
            continue
        bend = acos((squared - upper * upper - lower * lower) / (2.0 * upper * lower))
        lean = atan2(lower * sin(bend), upper + lower * cos(bend))
        towards = atan2(v, u)
        for knee in (1.0, -1.0):
            femur = _wrapped(towards - knee * lean - dh[1, 0])
            tibia = _wrapped(knee * bend - dh[2, 0])
            if not (
                limits[0, 0] <= yaw <= limits[0, 1]
                and limits[1, 0] <= femur <= limits[1, 1]
                and limits[2, 0] <= tibia <= limits[2, 1]
            ):
                continue
            far = max(abs(yaw - previous[0]), abs(femur - previous[1]), abs(tibia - previous[2]))
            if far < nearest:
                found, nearest = True, far
                solution[0], solution[1], solution[2] = yaw, femur, tibia
    return found


@kernel
def _wrapped(angle: float) -> float:
    return (angle + pi) % (2.0 * pi) - pi
