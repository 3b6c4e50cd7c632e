"""Classical Denavit-Hartenberg rows of a leg from the lines its joints turn about.

Where a line leaves a choice (axes that meet, are parallel or the same), a row is like that of the robot's first leg, so
that all legs share one table.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PARALLEL = 2e-3
"""rad between axes that count as parallel: as DH rows, they would meet far outside the robot."""
MEET = 1e-7
"""m between axes that meet, of 1 m of leg."""


def dh_rows(points: Array, axes: Array, foot: Array, like: Array | None = None) -> Array:
    """Rows theta, d, r, alpha (n, 4) at zero angles of a chain whose first axis is z through the origin.

    `points` and `axes` (n, 3) are the lines, `foot` (3,) where the last frame belongs; `like` (n, 4) settles choices.
    """
    count = len(axes)
    origin, x, z = np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    size = float(np.linalg.norm(np.diff(np.vstack([points, foot]), axis=0), axis=1).sum())
    rows = np.zeros((count, 4))
    for i in range(count):
        guide = None if like is None else like[i]
        y = np.cross(z, x)
        if i == count - 1:
            to, next_z = foot - origin, z
            d, turned = float(to @ z), to - (to @ z) * z
        else:
            to, next_z = points[i + 1] - origin, axes[i + 1]
            across = np.cross(z, next_z)
            angle = float(np.linalg.norm(across))
            if angle < PARALLEL:
                next_z = z if float(z @ next_z) > 0.0 else -z
                d, turned = 0.0, to - (to @ z) * z
            else:
                normal = across / angle
                distance = float(to @ normal)
                d = float(np.cross(to, next_z) @ normal) / angle
                turned = distance * normal
                if abs(distance) < MEET * size:
                    turned = np.zeros(3)
                    next_x = _like(normal, x, y, z, next_z, guide)
                    rows[i] = _row(x, y, z, next_x, next_z, d, 0.0)
                    origin, x, z = origin + d * z, next_x, next_z
                    continue
        r = float(np.linalg.norm(turned))
        if r < MEET * size:
            r, theta = 0.0, 0.0 if guide is None else float(guide[0])
            next_x = cos(theta) * x + sin(theta) * y
        else:
            next_x = turned / r
        rows[i] = _row(x, y, z, next_x, next_z, d, r)
        origin, x, z = origin + d * z + r * next_x, next_x, next_z
    return rows


def _like(normal: Array, x: Array, y: Array, z: Array, next_z: Array, guide: Array | None) -> Array:
    """Which normal of axes that meet: the one with the guide's alpha, or with a theta of a quarter turn at most."""
    if guide is not None:
        alpha = atan2(float(np.cross(z, next_z) @ normal), float(z @ next_z))
        return normal if abs(angle_between(alpha, float(guide[3]))) < 0.5 * pi * 1e-3 + 1e-3 else -normal
    theta = atan2(float(normal @ y), float(normal @ x))
    return normal if -0.5 * pi + 1e-6 < theta <= 0.5 * pi + 1e-6 else -normal


def _row(x: Array, y: Array, z: Array, next_x: Array, next_z: Array, d: float, r: float) -> Array:
    theta = atan2(float(next_x @ y), float(next_x @ x))
    alpha = atan2(float(np.cross(z, next_z) @ next_x), float(z @ next_z))
    return np.array([theta, d, r, alpha])


def hips(axis: Array) -> list[tuple[float, float]]:
    """Yaw and roll (rad) whose RotZ(yaw) RotX(roll) turns z into `axis` (3,); for a vertical one yaw is free, so 0."""
    flat = sqrt(axis[0] ** 2 + axis[1] ** 2)
    if flat < 1e-9:
        return [(0.0, 0.0 if axis[2] > 0.0 else pi)]
    roll, yaw = atan2(flat, float(axis[2])), atan2(float(axis[0]), float(-axis[1]))
    return [(yaw, roll), (yaw - pi if yaw > 0.0 else yaw + pi, -roll)]


def angle_between(a: float, b: float) -> float:
    """The way from b to a in rad, -pi to pi."""
    return float((a - b + pi) % (2.0 * pi) - pi)
