"""Epipolar tests with known rotation: two rays give the direction of travel, the others vote (2-point RANSAC)."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled

Array = NDArray[np.float64]


@compiled
def off_plane(direction: Array, before: Array, after: Array) -> float:
    """Sine of the angle between the ray `after` and the plane of `direction` and `before` (all unit vectors)."""
    nx = direction[1] * before[2] - direction[2] * before[1]
    ny = direction[2] * before[0] - direction[0] * before[2]
    nz = direction[0] * before[1] - direction[1] * before[0]
    length = float(np.sqrt(nx * nx + ny * ny + nz * nz))
    if length < 1e-9:
        return 0.0
    return float(abs(nx * after[0] + ny * after[1] + nz * after[2])) / length


@compiled
def consistent(before: Array, after: Array, pairs: NDArray[np.int64], gate: float) -> NDArray[np.bool_]:
    """Rays (n, 3) that agree on one direction of travel within `gate` (rad).

    `before` are the old rays turned into the new picture's axes by the gyro; `pairs` (m, 2) are the hypotheses. Rays
    that did not move agree with every direction, so a robot at rest loses nothing.
    """
    count = before.shape[0]
    best = np.ones(count, dtype=np.bool_)
    best_score = -1
    for h in range(pairs.shape[0]):
        i, k = pairs[h, 0], pairs[h, 1]
        first = np.cross(before[i], after[i])
        second = np.cross(before[k], after[k])
        direction = np.cross(first, second)
        length = np.sqrt(np.sum(direction * direction))
        if length < 1e-12:
            continue
        direction /= length
        score = 0
        for n in range(count):
            if off_plane(direction, before[n], after[n]) < gate:
                score += 1
        if score > best_score:
            best_score = score
            for n in range(count):
                best[n] = off_plane(direction, before[n], after[n]) < gate
    return best


def unit_rays(plane: Array) -> Array:
    """Unit vectors (n, 3) through points (n, 2) of the plane z = 1."""
    rays = np.column_stack([plane, np.ones(len(plane))])
    return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))
