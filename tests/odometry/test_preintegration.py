"""Preintegrated inertia is what brute-force integration gives, biases and uncertainty included."""

import numpy as np
import pytest
from walking_motion import Walk, as_samples, inertia

from robot_agent.odometry.preintegration import Preintegrations, begin, corrected, integrate
from robot_agent.odometry.propagation import propagate
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import rotation_log

BEGIN, END = 3_000_000_000, 3_500_000_000


def _integrated(samples: np.ndarray, gyro_bias: np.ndarray, accel_bias: np.ndarray) -> Preintegrations:
    pre = Preintegrations.of(2)
    begin(pre, 1, gyro_bias, accel_bias)
    integrate(pre, 1, samples, 5e-4, 8e-4)
    return pre


def test_preintegration_follows_a_walk_to_micrometres(robot: RobotDescription) -> None:
    walk, mount = Walk(sway=2.0), robot.imu.body_from_imu
    pre = _integrated(as_samples(inertia(walk, robot, BEGIN, END)), np.zeros(3), np.zeros(3))
    first, second = walk.body(BEGIN * 1e-9) @ mount, walk.body(END * 1e-9) @ mount
    dt = (END - BEGIN) * 1e-9
    velocity = walk.velocity(BEGIN * 1e-9, mount)
    moved = second.position - first.position - velocity * dt + [0.0, 0.0, 0.5 * GRAVITY * dt**2]
    assert rotation_log(pre.rotation[1].T @ first.rotation.T @ second.rotation) == pytest.approx(0.0, abs=1e-6)
    assert pre.position[1] == pytest.approx(first.rotation.T @ moved, abs=2e-5)


def test_the_state_carried_forward_is_the_preintegrated_one(robot: RobotDescription) -> None:
    walk, mount = Walk(), robot.imu.body_from_imu
    samples = as_samples(inertia(walk, robot, BEGIN, END))
    first = walk.body(BEGIN * 1e-9) @ mount
    velocity = walk.velocity(BEGIN * 1e-9, mount)
    rotation, position, _ = propagate(first.rotation, first.position, velocity, np.zeros(3), np.zeros(3), samples)
    second = walk.body(END * 1e-9) @ mount
    assert position == pytest.approx(second.position, abs=2e-5)
    assert rotation == pytest.approx(second.rotation, abs=1e-6)


def test_a_bias_correction_needs_no_second_integration(robot: RobotDescription) -> None:
    samples = as_samples(inertia(Walk(sway=2.0), robot, BEGIN, END))
    gyro, accel = np.array([2e-4, -3e-4, 1e-4]), np.array([2e-3, 1e-3, -3e-3])
    pre = _integrated(samples, np.zeros(3), np.zeros(3))
    again = _integrated(samples, gyro, accel)
    rotation, velocity, position = corrected(pre, 1, gyro, accel)
    for approximate, exact, old in (
        (rotation, again.rotation[1], pre.rotation[1]),
        (velocity, again.velocity[1], pre.velocity[1]),
        (position, again.position[1], pre.position[1]),
    ):
        assert np.abs(approximate - exact).max() < 0.01 * np.abs(exact - old).max()


def test_two_halves_appended_are_the_whole(robot: RobotDescription) -> None:
    samples = as_samples(inertia(Walk(), robot, BEGIN, END))
    whole = _integrated(samples, np.zeros(3), np.zeros(3))
    halves = _integrated(samples[:50], np.zeros(3), np.zeros(3))
    integrate(halves, 1, samples[50:], 5e-4, 8e-4)
    for mine, other in zip(halves, whole, strict=True):
        assert mine[1] == pytest.approx(other[1], rel=1e-9, abs=1e-9)


def test_covariance_is_the_scatter_of_noisy_integrations() -> None:
    random = np.random.default_rng(3)
    gyro_density, accel_density, dt = 5e-3, 2e-2, 0.005
    clean = np.tile([dt, 0.4, -0.2, 0.8, 1.0, -2.0, GRAVITY], (40, 1))
    reference = Preintegrations.of(2)
    begin(reference, 1, np.zeros(3), np.zeros(3))
    integrate(reference, 1, clean, gyro_density, accel_density)
    errors = []
    for _ in range(1500):
        noisy = clean.copy()
        noisy[:, 1:4] += random.normal(0.0, gyro_density / np.sqrt(dt), (40, 3))
        noisy[:, 4:] += random.normal(0.0, accel_density / np.sqrt(dt), (40, 3))
        pre = _integrated(noisy, np.zeros(3), np.zeros(3))
        turn = rotation_log(reference.rotation[1].T @ pre.rotation[1])
        way = pre.position[1] - reference.position[1]
        errors.append(np.concatenate([turn, pre.velocity[1] - reference.velocity[1], way]))
    scatter = np.diag(np.cov(np.array(errors).T))
    assert np.diag(reference.covariance[1]) == pytest.approx(scatter, rel=0.15)
