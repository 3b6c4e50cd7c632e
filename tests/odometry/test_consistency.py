"""The normalised error of an honest estimator averages to its degrees of freedom, inside the band."""

import numpy as np
import pytest

from robot_agent.evaluation.consistency import band_of_mean, normalised_error
from weaver_shared.transforms import Pose, rotation_exp

COVARIANCE = np.diag([1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4])


def test_errors_drawn_from_the_covariance_lie_in_the_band_and_doubled_ones_do_not() -> None:
    random = np.random.default_rng(3)
    draws = random.multivariate_normal(np.zeros(6), COVARIANCE, 200)
    errors = [normalised_error(Pose.identity(), _pose(d), COVARIANCE) for d in draws]
    low, high = band_of_mean(200)
    assert low < np.mean(errors) < high
    assert np.mean([normalised_error(Pose.identity(), _pose(2.0 * d), COVARIANCE) for d in draws]) > high


def test_one_standard_deviation_counts_one() -> None:
    assert normalised_error(Pose.identity(), _pose(np.array([0.01, 0, 0, 0, 0, 0])), COVARIANCE) == pytest.approx(1.0)


def _pose(error: np.ndarray) -> Pose:
    return Pose(rotation=rotation_exp(error[:3]), position=error[3:])
