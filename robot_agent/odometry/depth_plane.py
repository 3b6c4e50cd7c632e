"""The ground as a guess of depth: the inverse depth of a plane is linear in undistorted picture coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled

Array = NDArray[np.float64]

LEAST_POINTS = 8


def fit_inverse_depth(plane: Array, depth: Array) -> Array | None:
    """Coefficients (3,) of 1 / depth over x, y, 1 for points (n, 2) with `depth` (n,) in m; None with too few."""
    known = np.isfinite(depth)
    if int(known.sum()) < LEAST_POINTS:
        return None
    return np.asarray(_robust_plane(plane[known], 1.0 / depth[known]))


@compiled
def _robust_plane(plane: Array, inverse: Array) -> Array:
    """A few reweighted rounds of least squares, so that steps and feet do not tilt the plane."""
    number = len(inverse)
    rows = np.ones((number, 3))
    rows[:, :2] = plane
    weight = np.ones(number)
    coefficients = np.zeros(3)
    for _ in range(3):
        normal = 1e-6 * np.eye(3)
        target = np.zeros(3)
        for n in range(number):
            for a in range(3):
                target[a] += weight[n] * rows[n, a] * inverse[n]
                for b in range(3):
                    normal[a, b] += weight[n] * rows[n, a] * rows[n, b]
        coefficients = np.linalg.solve(normal, target).astype(np.float64)
        error = np.abs(rows @ coefficients - inverse)
        typical = max(float(np.median(error)), 1e-6)
        for n in range(number):
            weight[n] = 1.0 / max(error[n] / typical, 1.0)
    return coefficients


def inverse_depth(coefficients: Array, plane: Array, farthest: float = 50.0) -> Array:
    """Inverse depth (n,) in 1/m at points (n, 2), never beyond `farthest` (m)."""
    return np.asarray(np.maximum(plane @ coefficients[:2] + coefficients[2], 1.0 / farthest))
