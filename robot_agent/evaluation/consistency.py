"""Is an estimator as sure as it may be? Normalised estimation error squared (Bar-Shalom et al. 2001, 5.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from weaver_shared.transforms import Pose, rotation_log

Array = NDArray[np.float64]

POSE_FREEDOM = 6


def normalised_error(estimated: Pose, truth: Pose, covariance: Array) -> float:
    """Squared error of a pose in units of its covariance (6, 6) of rotation (body, rad), then position (world, m)."""
    turn = rotation_log(estimated.rotation.T @ truth.rotation)
    error = np.concatenate([turn, truth.position - estimated.position])
    return float(error @ np.linalg.solve(covariance, error))


def band_of_mean(runs: int, confidence: float = 0.95) -> tuple[float, float]:
    """Where the mean of `runs` independent normalised errors of a pose lies if the covariance is right."""
    tail = 0.5 * (1.0 - confidence)
    low, high = chi2.ppf([tail, 1.0 - tail], POSE_FREEDOM * runs) / runs
    return float(low), float(high)
