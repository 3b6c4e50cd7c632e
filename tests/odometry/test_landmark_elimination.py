"""Eliminating landmarks one by one gives the same system as solving for everything at once."""

import numpy as np
import pytest

from robot_agent.odometry.landmark_elimination import Elimination, add_reprojections, move_points
from robot_agent.odometry.landmarks import Eyes, Landmarks
from robot_agent.odometry.reprojection_factor import common_as_poses, exposure_views, observation_rows, whitened_error
from robot_agent.odometry.window_state import COMMON, STATE, Frames, unknowns
from weaver_shared.transforms import rotation_from_rpy

FRAMES, POINTS, PER_SIGMA, HUBER, TRUST = 3, 7, 400.0, 1.0, 0.7


def _scene(eyes: Eyes) -> tuple[Frames, Landmarks]:
    random = np.random.default_rng(3)
    frames, landmarks = Frames.of(FRAMES), Landmarks.of(POINTS + 1, FRAMES)
    for k in range(FRAMES):
        frames.rotation[k] = rotation_from_rpy(*random.normal(0.0, 0.05, 3))
        frames.position[k] = random.normal(0.0, 0.05, 3)
        frames.velocity[k] = random.normal(0.0, 0.3, 3)
        frames.rate[k] = random.normal(0.0, 0.3, 3)
    _, _, views = exposure_views(frames, eyes, FRAMES)
    for row in range(POINTS):
        in_eye = np.array([*random.uniform(-0.3, 0.3, 2), random.uniform(0.5, 1.5)])
        landmarks.identity[row], landmarks.solved[row] = row, True
        landmarks.point[row] = views.rotation[0, 0].T @ (in_eye - views.translation[0, 0])
        for k in range(FRAMES):
            landmarks.seen[row, k] = (3, 1, 3, 2, 3, 0, 3)[(row + k) % 7]
            for e in range(2):
                seen = views.rotation[k, e] @ landmarks.point[row] + views.translation[k, e]
                landmarks.observation[row, k, e] = seen[:2] / seen[2] + random.normal(0.0, 0.003, 2)
    return frames, landmarks


def _whole_system(frames: Frames, landmarks: Landmarks, eyes: Eyes) -> tuple[np.ndarray, np.ndarray, float]:
    """Normal equations of all frames and landmarks together, landmarks last; and the robust cost."""
    size = unknowns(FRAMES)
    hessian, gradient = np.zeros((size + 3 * POINTS,) * 2), np.zeros(size + 3 * POINTS)
    rotation, position, views = exposure_views(frames, eyes, FRAMES)
    common = common_as_poses(frames, rotation, FRAMES)
    cost = 0.0
    for row in range(POINTS):
        for k in range(FRAMES):
            for e in range(2):
                if not landmarks.seen[row, k] & (1 << e):
                    continue
                rows = np.zeros((4, 11))
                observation_rows(rotation, position, eyes, views, landmarks.point, row, k, e, rows)
                part = PER_SIGMA * rows[2 * e : 2 * e + 2]
                jacobian = np.zeros((2, len(gradient)))
                jacobian[:, STATE * k : STATE * k + 6] = part[:, :6]
                jacobian[:, size - COMMON : size] = part[:, :6] @ common[6 * k : 6 * k + 6]
                jacobian[:, size + 3 * row : size + 3 * row + 3] = part[:, 6:9]
                error = np.array(whitened_error(views, landmarks, row, k, e, PER_SIGMA))
                length = float(np.linalg.norm(error))
                weight = min(1.0, HUBER / length)
                cost += 0.5 * length**2 if length <= HUBER else HUBER * (length - 0.5 * HUBER)
                hessian += weight * jacobian.T @ jacobian
                gradient += weight * jacobian.T @ error
    return hessian, gradient, cost


def test_the_eliminated_system_and_the_points_steps_are_those_of_the_whole(eyes: Eyes) -> None:
    frames, landmarks = _scene(eyes)
    whole, pull, whole_cost = _whole_system(frames, landmarks, eyes)
    size = unknowns(FRAMES)
    own = np.linalg.inv(whole[size:, size:])
    expected = whole[:size, :size] - whole[:size, size:] @ own @ whole[size:, :size]
    hessian, gradient = np.zeros((size, size)), np.zeros(size)
    elimination = Elimination.of(POINTS + 1, FRAMES)
    chosen = np.ones(POINTS + 1, dtype=np.bool_)
    cost = add_reprojections(
        frames, frames, landmarks, chosen, eyes, FRAMES, PER_SIGMA, HUBER, TRUST, elimination, hessian, gradient
    )
    scale = float(np.abs(expected).max())
    assert cost == pytest.approx(TRUST * whole_cost)
    assert hessian == pytest.approx(TRUST * np.triu(expected), abs=1e-6 * scale)
    reduced = pull[:size] - whole[:size, size:] @ own @ pull[size:]
    assert gradient == pytest.approx(TRUST * reduced, rel=1e-6, abs=1e-3)

    step = np.random.default_rng(8).normal(0.0, 1e-3, size)
    before = landmarks.point.copy()
    move_points(landmarks, elimination, FRAMES, step)
    by_row = -own @ (pull[size:] + whole[size:, :size] @ step)
    assert (landmarks.point - before)[:POINTS] == pytest.approx(by_row.reshape(-1, 3), rel=1e-5, abs=1e-7)


def test_a_landmark_behind_every_eye_says_nothing(eyes: Eyes) -> None:
    frames, landmarks = _scene(eyes)
    landmarks.identity[1:] = -1
    landmarks.solved[1:] = False
    _, _, views = exposure_views(frames, eyes, FRAMES)
    ahead = views.rotation[0, 0].T @ np.array([0.0, 0.0, -2.0])
    landmarks.point[0] = frames.position[0] + ahead
    hessian, gradient = np.zeros((unknowns(FRAMES),) * 2), np.zeros(unknowns(FRAMES))
    elimination = Elimination.of(POINTS + 1, FRAMES)
    chosen = np.ones(POINTS + 1, dtype=np.bool_)
    add_reprojections(
        frames, frames, landmarks, chosen, eyes, FRAMES, PER_SIGMA, HUBER, TRUST, elimination, hessian, gradient
    )
    move_points(landmarks, elimination, FRAMES, np.ones(unknowns(FRAMES)))
    assert not hessian.any()
    assert not gradient.any()
    assert landmarks.point[0] == pytest.approx(frames.position[0] + ahead)
