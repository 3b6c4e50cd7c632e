"""The window follows a walk over seen landmarks, forgets consistently and knows how sure it is."""

import numpy as np
import pytest
from walking_motion import FRAME_NS, Ground, Walk, as_samples, begin_window, inertia

from robot_agent.odometry.landmarks import Eyes
from robot_agent.odometry.prior import Prior, eliminate
from robot_agent.odometry.tracks import Tracks
from robot_agent.odometry.window import SlidingWindow
from robot_agent.odometry.window_state import COMMON, STATE, Frames, unknowns
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import OdometryConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import rotation_log

GYRO_BIAS, ACCEL_BIAS = np.array([0.003, -0.004, 0.002]), np.array([0.02, -0.03, 0.02])


class Followed:
    """A window led along a walk: final error, path and normalised error of the newest pose."""

    def __init__(
        self,
        robot: RobotDescription,
        calibration: StereoCalibration,
        eyes: Eyes,
        seed: int,
        seconds: float,
        **world: float,
    ) -> None:
        random = np.random.default_rng(seed)
        walk, mount = Walk(), robot.imu.body_from_imu
        ground = Ground(calibration, eyes, random, features=80)
        window = SlidingWindow(eyes, robot.imu, calibration.left.fx, OdometryConfig())

        def sense(begin: int, end: int) -> np.ndarray:
            return as_samples(inertia(walk, robot, begin, end, random, GYRO_BIAS, ACCEL_BIAS))

        samples = sense(0, 10 * FRAME_NS)
        start = walk.body(0.5) @ mount
        begin_window(window, robot, start, samples, 10 * FRAME_NS)
        window.see(ground.tracks(start))
        self.most_frames = 0
        for k in range(11, round(seconds * 1e9) // FRAME_NS):
            self.truth = walk.body(k * FRAME_NS * 1e-9) @ mount
            samples = sense((k - 1) * FRAME_NS, k * FRAME_NS)
            rate = samples[-1, 1:4] - window.frames.gyro_bias[window.newest]
            tracks = ground.tracks(self.truth, outliers=world.get("outliers", 0.0))
            window.add_frame(k * FRAME_NS, samples, rate, tracks, resting=False)
            solved, wrong = window.optimise()
            assert solved
            ground.forget(wrong)
            self.most_frames = max(self.most_frames, window.count)
        n = window.newest
        self.window = window
        self.error = window.frames.position[n] - self.truth.position
        self.turn_error = rotation_log(window.frames.rotation[n].T @ self.truth.rotation)
        self.path = float(np.linalg.norm(self.truth.position - start.position))
        error = np.concatenate([self.turn_error, -self.error])
        self.normalised = float(error @ np.linalg.solve(window.pose_covariance(), error))


def test_a_walk_over_landmarks_drifts_little(
    robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes
) -> None:
    walked = Followed(robot, calibration, eyes, seed=1, seconds=10.0)
    assert walked.most_frames == 11
    assert walked.path > 1.2
    assert np.linalg.norm(walked.error[:2]) < 0.004 * walked.path
    assert np.abs(walked.turn_error).max() < 0.006
    assert walked.window.frames.gyro_bias[walked.window.newest] == pytest.approx(GYRO_BIAS, abs=8e-4)
    assert abs(walked.window.frames.time_offset[0]) < 0.0015


def test_a_tenth_of_wrong_matches_does_no_harm(
    robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes
) -> None:
    walked = Followed(robot, calibration, eyes, seed=2, seconds=5.0, outliers=0.1)
    assert np.linalg.norm(walked.error) < 0.03


def test_the_window_knows_how_sure_it_is(robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes) -> None:
    normalised = [Followed(robot, calibration, eyes, seed=s, seconds=3.5).normalised for s in range(10, 14)]
    assert 1.0 < np.mean(normalised) < 13.0  # 6 degrees of freedom; chi-squared of 4 runs, 99 %: 2.5 to 11.4


def test_eliminating_a_frame_leaves_the_others_solution_alone() -> None:
    random = np.random.default_rng(4)
    size = unknowns(3)
    root = random.normal(0.0, 1.0, (size, size + 5))
    hessian, gradient = root @ root.T, random.normal(0.0, 1.0, size)
    whole = np.linalg.solve(hessian, -gradient)
    reduced, remaining = eliminate(hessian, gradient, 1)
    rest = np.r_[0:STATE, 2 * STATE : size]
    assert np.linalg.solve(reduced[np.ix_(rest, rest)], -remaining[rest]) == pytest.approx(whole[rest], abs=1e-6)
    inverse = np.linalg.inv(hessian)[np.ix_(rest, rest)]
    assert np.linalg.inv(reduced[np.ix_(rest, rest)]) == pytest.approx(inverse, rel=1e-5, abs=1e-8)


def test_a_prior_pulls_with_its_first_estimate_after_the_states_moved() -> None:
    frames = Frames.of(3)
    prior = Prior(3)
    prior.begin(frames, 4.0 * np.eye(STATE), np.full(COMMON, 0.003))
    prior.append_frame()
    prior.linearise_at(frames)
    frames.position[0] += [0.1, 0.0, -0.2]
    hessian, gradient = np.zeros((unknowns(2), unknowns(2))), np.zeros(unknowns(2))
    prior.linearise_at(frames)
    prior.add_to(frames, hessian, gradient)
    assert gradient[3:6] == pytest.approx([0.4, 0.0, -0.8])
    tied = hessian.copy()
    tied[:STATE, STATE : 2 * STATE] = tied[STATE : 2 * STATE, :STATE] = 0.1 * np.eye(STATE)
    prior.replace(frames, tied, gradient)
    again, same = np.zeros_like(tied), np.zeros_like(gradient)
    prior.add_to(frames, again, same)
    assert same == pytest.approx(gradient)
    assert prior.fixed[:2].all()


def test_a_body_that_trembles_stays_where_it_rests_though_one_moment_looks_like_motion(
    robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes
) -> None:
    random = np.random.default_rng(6)
    window = SlidingWindow(eyes, robot.imu, calibration.left.fx, OdometryConfig())
    window.begin(
        0,
        rotation=np.eye(3),
        position=np.zeros(3),
        velocity=np.zeros(3),
        gyro_bias=np.zeros(3),
        accel_bias=np.zeros(3),
        rate=np.zeros(3),
        information=np.diag(1.0 / np.repeat([1e-4, 1e-4, 1e-3, 1e-3, 0.05], 3) ** 2),
    )
    farthest = 0.0
    for k in range(1, 60):
        samples = np.tile([0.005, 0.0, 0.0, 0.0, 0.0, 0.0, GRAVITY], (10, 1))
        samples[:, 4:7] += random.normal(0.0, 1.0, (10, 3))  # far beyond the described noise
        window.add_frame(k * FRAME_NS, samples, np.zeros(3), Tracks.none("dark"), resting=k != 20)
        assert window.optimise()[0]
        if k > 24:
            farthest = max(farthest, float(np.linalg.norm(window.frames.position[window.newest])))
    assert farthest < 0.02
