"""Robust weights: Huber's, with the scale taken from the middle of the residuals."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAST_SIGMA = 0.01
"""Below this many pixels no corner is told from the next."""

BEND = 3.0
"""Where squares turn into lengths, in sigmas."""

WILD = 6.0
"""What is further off than this many sigmas is no measurement."""


def sigma_of(residuals: Array) -> float:
    """Standard deviation (px, of each coordinate) by the median length of (n, 2); outliers do not move it."""
    lengths = np.linalg.norm(residuals, axis=1)
    lengths = lengths[np.isfinite(lengths)]
    if len(lengths) == 0:
        return LEAST_SIGMA
    return max(LEAST_SIGMA, float(np.median(lengths)) / 1.1774)  # Rayleigh's median


def huber_cost(residuals: Array, sigma: float) -> float:
    """Sum over corners (n, 2); a point behind the lens costs as one a hundred sigmas off."""
    lengths = np.nan_to_num(np.linalg.norm(residuals, axis=1) / sigma, nan=100.0, posinf=1e6)
    return float(np.where(lengths < BEND, 0.5 * lengths**2, BEND * (lengths - 0.5 * BEND)).sum())


def huber_weights(residuals: Array, sigma: float) -> Array:
    """Weights (n,) in 1 / px^2."""
    lengths = np.linalg.norm(residuals, axis=1) / sigma
    with np.errstate(invalid="ignore", divide="ignore"):
        weights = np.where(lengths < BEND, 1.0, BEND / lengths)
    return np.nan_to_num(weights) / sigma**2
