"""The kernels' rotations are those of the shared transforms, and their Jacobians those of finite differences."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robot_agent.odometry.rotations import (
    exponential,
    inverse_right_jacobian,
    logarithm,
    orthonormal,
    right_jacobian,
)
from weaver_shared.transforms import rotation_exp

vectors = arrays(np.float64, 3, elements=st.floats(-1.5, 1.5))


@given(vectors)
@settings(max_examples=60, deadline=None)
def test_exponential_is_rodrigues_and_logarithm_undoes_it(vector: np.ndarray) -> None:
    assert exponential(vector) == pytest.approx(rotation_exp(vector), abs=1e-9)
    assert logarithm(exponential(vector)) == pytest.approx(vector, abs=1e-7)


@given(vectors)
@settings(max_examples=40, deadline=None)
def test_right_jacobian_is_the_derivative_of_the_exponential(vector: np.ndarray) -> None:
    h = 1e-6
    numeric = np.stack(
        [logarithm(exponential(vector).T.copy() @ exponential(vector + h * axis)) / h for axis in np.eye(3)], axis=1
    )
    assert right_jacobian(vector) == pytest.approx(numeric, abs=1e-5)
    assert right_jacobian(vector) @ inverse_right_jacobian(vector) == pytest.approx(np.eye(3), abs=1e-9)


@pytest.mark.parametrize("axis", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.6, -0.8]])
def test_half_a_turn_has_a_logarithm(axis: list[float]) -> None:
    half_turn = rotation_exp(np.pi * np.array(axis))
    assert exponential(logarithm(half_turn)) == pytest.approx(half_turn, abs=1e-7)


def test_rounding_is_undone() -> None:
    dirty = rotation_exp([0.3, -0.2, 0.9]) + 1e-6 * np.random.default_rng(0).normal(size=(3, 3))
    clean = orthonormal(dirty)
    assert clean @ clean.T == pytest.approx(np.eye(3), abs=1e-10)
