"""The ground as a guess of depth: the inverse depth of a plane is linear in undistorted picture coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAST_POINTS = 8


def fit_inverse_depth(plane: Array, depth: Array) -> Array | None:
    """Coefficients (3,) of 1 / depth over x, y, 1 for points (n, 2) with `depth` (n,) in m; None with too few."""
    known = np.isfinite(depth)
    if int(known.sum()) < LEAST_POINTS:
        return None
    rows = np.column_stack([plane[known], np.ones(int(known.sum()))])
    inverse = 1.0 / depth[known]
    weight: Array = np.ones(len(inverse))
    coefficients: Array = np.zeros(3)
    for _ in range(3):  # a few reweighted rounds, so that steps and feet do not tilt the plane
        normal = rows.T @ (rows * weight[:, None]) + 1e-6 * np.eye(3)
        coefficients = np.asarray(np.linalg.solve(normal, rows.T @ (weight * inverse)), dtype=np.float64)
        error = np.abs(rows @ coefficients - inverse)
        weight = 1.0 / np.maximum(error / max(float(np.median(error)), 1e-6), 1.0)
    return coefficients


def inverse_depth(coefficients: Array, plane: Array, farthest: float = 50.0) -> Array:
    """Inverse depth (n,) in 1/m at points (n, 2), never beyond `farthest` (m)."""
    return np.asarray(np.maximum(plane @ coefficients[:2] + coefficients[2], 1.0 / farthest))
