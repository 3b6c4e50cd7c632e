"""Every factor's Jacobian is the derivative of its error."""

from collections.abc import Callable

import numpy as np
import pytest

from robot_agent.odometry.inertial_factor import inertial_jacobian, inertial_residual
from robot_agent.odometry.landmarks import Eyes, Landmarks
from robot_agent.odometry.preintegration import Preintegrations, begin, integrate
from robot_agent.odometry.reprojection_factor import (
    common_as_poses,
    exposure_views,
    mounted,
    observation_rows,
    whitened_error,
)
from robot_agent.odometry.rest_factor import rest_jacobian, rest_residual
from robot_agent.odometry.way_factor import Ways, way_jacobian, way_residual
from robot_agent.odometry.window_state import STATE, Frames, advance, unknowns
from weaver_shared.transforms import rotation_from_rpy

STEP = 1e-6


def _two_frames() -> Frames:
    random = np.random.default_rng(5)
    frames = Frames.of(3)
    for k in range(2):
        frames.rotation[k] = rotation_from_rpy(*random.normal(0.0, 0.3, 3))
        frames.position[k] = random.normal(0.0, 0.2, 3)
        frames.velocity[k] = random.normal(0.0, 0.3, 3)
        frames.gyro_bias[k] = random.normal(0.0, 0.01, 3)
        frames.accel_bias[k] = random.normal(0.0, 0.05, 3)
        frames.rate[k] = random.normal(0.0, 0.3, 3)
    return frames


def _numeric(frames: Frames, error: Callable[[Frames], np.ndarray]) -> np.ndarray:
    columns = []
    for n in range(unknowns(2)):
        ends = []
        for sign in (1.0, -1.0):
            moved = Frames(*(array.copy() for array in frames))
            step = np.zeros(unknowns(2))
            step[n] = sign * STEP
            advance(moved, 2, step)
            ends.append(error(moved))
        columns.append((ends[0] - ends[1]) / (2.0 * STEP))
    return np.stack(columns, axis=1)


def test_inertial_factor() -> None:
    frames, pre = _two_frames(), Preintegrations.of(3)
    samples = np.tile([0.005, 0.3, -0.5, 0.2, 0.4, -0.3, 9.7], (20, 1))
    begin(pre, 1, np.array([0.002, 0.0, -0.001]), np.array([0.01, 0.0, 0.02]))
    integrate(pre, 1, samples, 5e-4, 8e-4)
    numeric = _numeric(frames, lambda f: inertial_residual(f, pre, 0, 1))[:, : 2 * STATE]
    assert inertial_jacobian(frames, pre, 0, 1) == pytest.approx(numeric, abs=2e-6)


def test_rest_factor() -> None:
    frames = _two_frames()
    numeric = _numeric(frames, lambda f: rest_residual(f, 1))[:, : 2 * STATE]
    assert rest_jacobian(frames, 1) == pytest.approx(numeric, abs=1e-6)


def test_way_factor() -> None:
    frames, ways = _two_frames(), Ways.of(3)
    ways.displacement[1] = [0.02, -0.01, 0.003]
    numeric = _numeric(frames, lambda f: way_residual(f, ways, 1))[:, : 2 * STATE]
    assert way_jacobian(frames, 1) == pytest.approx(numeric, abs=1e-6)


@pytest.mark.parametrize("eye", [0, 1])
def test_reprojection_factor(eyes: Eyes, eye: int) -> None:
    frames, landmarks = _two_frames(), Landmarks.of(1, 3)
    frames.time_offset[0] = 0.004
    frames.rig_rotation[:] = rotation_from_rpy(0.02, -0.03, 0.01)
    frames.rig_shift[:] = [0.003, -0.005, 0.004]
    rotation, position, views = exposure_views(frames, eyes, 2)
    seats = mounted(frames, eyes)
    in_front = seats.rotation[eye].T @ (np.array([0.1, -0.15, 0.8]) - seats.translation[eye])
    landmarks.point[0] = rotation[1] @ in_front + position[1]
    landmarks.observation[0, 1, eye] = [0.1, -0.2]

    def error(moved: Frames) -> np.ndarray:
        _, _, seen_from = exposure_views(moved, eyes, 2)
        return np.array(whitened_error(seen_from, landmarks, 0, 1, eye, 100.0))

    rows = np.zeros((4, 12))
    observation_rows(rotation, position, seats, views, landmarks.point, 0, 1, eye, rows)
    by_pose, by_point = 100.0 * rows[2 * eye : 2 * eye + 2, :6], 100.0 * rows[2 * eye : 2 * eye + 2, 6:9]
    numeric = _numeric(frames, error)
    assert by_pose == pytest.approx(numeric[:, STATE : STATE + 6], rel=1e-2, abs=0.1)  # linearised without the offset
    by_common = by_pose @ common_as_poses(frames, rotation, 2)[6:12]
    assert by_common == pytest.approx(numeric[:, 2 * STATE :], rel=1e-2, abs=0.1)  # linearised without the offset
    for axis in range(3):
        base = np.array(whitened_error(views, landmarks, 0, 1, eye, 100.0))
        landmarks.point[0, axis] += STEP
        moved = (np.array(whitened_error(views, landmarks, 0, 1, eye, 100.0)) - base) / STEP
        landmarks.point[0, axis] -= STEP
        assert by_point[:, axis] == pytest.approx(moved, abs=1e-3)
