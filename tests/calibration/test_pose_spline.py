"""The spline: its basis, its derivatives in time and by its controls."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.calibration.inertial_kernels import pose_at
from robot_agent.calibration.spline import ORDER, blending, exponential, logarithm, rotation_at, weights

INTERVAL = 0.04


def controls(seed: int, count: int = ORDER + 3, spread: float = 0.3) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(seed)
    rotations = [exponential(generator.normal(0.0, 1.0, 3))]
    for _ in range(count - 1):
        rotations.append(rotations[-1] @ exponential(generator.normal(0.0, spread, 3)))
    return np.array(rotations), np.cumsum(generator.normal(0.0, 0.1, (count, 3)), axis=0)


def at(time: float, rotations: np.ndarray, positions: np.ndarray):
    scratch = np.empty((3, 6)), np.empty((6, 3, 3)), np.empty((6, 3, 3))
    return pose_at(blending(), INTERVAL, time, rotations, positions, *scratch)


def test_cumulative_weights_begin_with_one_and_fall() -> None:
    result = np.empty((3, 6))
    for fraction in np.linspace(0.0, 0.999, 7):
        weights(blending(), fraction, INTERVAL, result)
        assert result[0, 0] == pytest.approx(1.0)
        assert (np.diff(result[0]) <= 1e-12).all()
        np.testing.assert_allclose(result[1:, 0], 0.0, atol=1e-9)


@given(st.integers(0, 1000), st.floats(0.001, 0.15))
def test_velocities_are_the_poses_derivatives(seed: int, time: float) -> None:
    rotations, positions = controls(seed)
    _, rotation, rate, _, velocity, acceleration = at(time, rotations, positions)
    step = 1e-6
    _, after, _, position_after, velocity_after, _ = at(time + step, rotations, positions)
    _, before, _, position_before, velocity_before, _ = at(time - step, rotations, positions)
    np.testing.assert_allclose(logarithm(before.T @ after) / (2 * step), rate, atol=1e-4)
    np.testing.assert_allclose((position_after - position_before) / (2 * step), velocity, atol=1e-5)
    np.testing.assert_allclose((velocity_after - velocity_before) / (2 * step), acceleration, rtol=1e-4, atol=1e-3)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)


@given(st.integers(0, 1000), st.floats(0.0, 0.999))
def test_derivatives_by_the_controls_are_those_of_differences(seed: int, fraction: float) -> None:
    rotations, _ = controls(seed, ORDER)
    lambdas, by_turn, by_rate, scratch = np.empty((3, 6)), *(np.empty((6, 3, 3)) for _ in range(3))
    weights(blending(), fraction, INTERVAL, lambdas)
    rotation, _ = rotation_at(rotations, lambdas, by_turn, by_rate)
    for control in range(ORDER):
        for axis in range(3):
            step = np.zeros(3)
            step[axis] = 1e-6
            moved = []
            for sign in (1.0, -1.0):
                other = rotations.copy()
                other[control] = rotations[control] @ exponential(sign * step)
                moved.append(rotation_at(other, lambdas, scratch, np.empty((6, 3, 3))))
            turn = (logarithm(rotation.T @ moved[0][0]) - logarithm(rotation.T @ moved[1][0])) / 2e-6
            np.testing.assert_allclose(by_turn[control][:, axis], turn, atol=1e-7)
            np.testing.assert_allclose(by_rate[control][:, axis], (moved[0][1] - moved[1][1]) / 2e-6, atol=2e-5)


def test_equal_controls_stand_still() -> None:
    rotations = np.repeat(exponential(np.array([0.3, -2.0, 1.0]))[None], 8, axis=0)
    _, rotation, rate, _, velocity, _ = at(0.05, rotations, np.ones((8, 3)))
    np.testing.assert_allclose(rotation, rotations[0], atol=1e-12)
    np.testing.assert_allclose(rate, 0.0, atol=1e-12)
    np.testing.assert_allclose(velocity, 0.0, atol=1e-9)
