"""Closed-form inverse kinematics of the yaw-roll-pitch-pitch-pitch leg (ICRA'17 III-C: last link along gravity).

The ankle is a = foot - L5 d, where d is the wanted direction of the last link. The three pitch links move in a plane
that contains the roll axis, which passes through the hip, and therefore hip, ankle and foot: its normal is
n = r x d with r from hip to foot. Yaw and roll turn the plane to n; femur and tibia are then a two-link arm. Tilting d
inside the plane leaves n alone, so where d itself can not be had the least tilt that can is found in the plane.
"""

from math import acos, atan2, cos, hypot, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]

TILT_STEP = 0.06
LARGEST_TILT = 1.5
STRAIGHT = 0.9998
"""Fraction of the stretched femur and tibia that may be used, short of the singularity."""


@kernel
def solve_closed_form(
    dh: Array,
    limits: Array,
    hip_in_body: Array,
    hip_axes: Array,
    foot_in_body: Array,
    direction: Array,
    solution: Array,
) -> bool:
    """Joints (5,) that put the foot exactly at `foot_in_body` (3,), last link along `direction` (3,) or nearest to it.

    False, with `solution` undefined, where the plane is not defined or no tilt keeps the limits.
    """
    c, s = hip_axes[0, 0], hip_axes[1, 0]
    fx, fy, rz = foot_in_body[0] - hip_in_body[0], foot_in_body[1] - hip_in_body[1], foot_in_body[2] - hip_in_body[2]
    rx, ry = c * fx + s * fy, -s * fx + c * fy
    dx, dy, dz = c * direction[0] + s * direction[1], -s * direction[0] + c * direction[1], direction[2]
    nx, ny, nz = ry * dz - rz * dy, rz * dx - rx * dz, rx * dy - ry * dx
    norm = sqrt(nx * nx + ny * ny + nz * nz)
    flat = hypot(nx, ny)
    if not (norm > 1e-6 and flat > 1e-3 * norm):
        return False
    nx, ny, nz = nx / norm, ny / norm, nz / norm
    # The outward axis is where the plane cuts the horizontal; its sign is the one nearer to the leg's own outside.
    ox, oy = ny, -nx
    if ox < 0.0:
        ox, oy, nx, ny, nz = -ox, -oy, -nx, -ny, -nz
    flat = hypot(ox, oy)
    ox, oy = ox / flat, oy / flat
    yaw = atan2(oy, ox)
    roll = atan2(nz, flat)
    if not (limits[0, 0] <= yaw <= limits[0, 1] and limits[1, 0] <= roll <= limits[1, 1]):
        return False
    # In the plane: u along the outward axis, v along n x u, which points down.
    vx, vy, vz = -nz * oy, nz * ox, nx * oy - ny * ox
    fu = rx * ox + ry * oy - dh[1, 1]
    fv = rx * vx + ry * vy + rz * vz
    heading = atan2(dx * vx + dy * vy + dz * vz, dx * ox + dy * oy)
    if _planar(dh, limits, fu, fv, heading, solution):
        solution[0], solution[1] = yaw, roll
        return True
    tilt = TILT_STEP
    while tilt < LARGEST_TILT:
        for side in (-1.0, 1.0):
            if _planar(dh, limits, fu, fv, heading + side * tilt, solution):
                bad, good = tilt - TILT_STEP, tilt
                for _ in range(14):
                    middle = 0.5 * (bad + good)
                    if _planar(dh, limits, fu, fv, heading + side * middle, solution):
                        good = middle
                    else:
                        bad = middle
                _planar(dh, limits, fu, fv, heading + side * good, solution)
                solution[0], solution[1] = yaw, roll
                return True
        tilt += TILT_STEP
    return False


@kernel
def _planar(dh: Array, limits: Array, fu: float, fv: float, heading: float, solution: Array) -> bool:
    """Femur, tibia and tarsus for the foot (fu, fv) with the last link at angle `heading`; False beyond a limit."""
    upper, lower, last = dh[2, 2], dh[3, 2], dh[4, 2]
    u, v = fu - last * cos(heading), fv - last * sin(heading)
    squared = u * u + v * v
    if squared > (STRAIGHT * (upper + lower)) ** 2:
        return False
    bend = (squared - upper * upper - lower * lower) / (2.0 * upper * lower)
    if not -1.0 <= bend <= 1.0:
        return False
    tibia = acos(bend)
    femur = atan2(v, u) - atan2(lower * sin(tibia), upper + lower * cos(tibia))
    femur = (femur + pi) % (2.0 * pi) - pi
    tarsus = (heading - femur - tibia + pi) % (2.0 * pi) - pi
    solution[2], solution[3], solution[4] = femur, tibia, tarsus
    within: bool = (
        limits[2, 0] <= femur <= limits[2, 1]
        and limits[3, 0] <= tibia <= limits[3, 1]
        and limits[4, 0] <= tarsus <= limits[4, 1]
    )
    return within
