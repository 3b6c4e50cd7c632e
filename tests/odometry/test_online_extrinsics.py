"""Eyes that sit a little elsewhere than calibrated are found out while walking; eyes that sit right are left alone."""

import numpy as np
import pytest
from walking_motion import FRAME_NS, Ground, Walk, as_samples, begin_window, inertia

from robot_agent.odometry.landmarks import Eyes
from robot_agent.odometry.window import SlidingWindow
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import OdometryConfig, WindowConfig
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_exp, rotation_log

GYRO_BIAS, ACCEL_BIAS = np.array([0.003, -0.004, 0.002]), np.array([0.02, -0.03, 0.02])
SECONDS = 12.0


def _moved(eyes: Eyes, imu_from_rig: Pose) -> Eyes:
    """The eyes on a rig that sits on the IMU like that."""
    poses = [Pose(rotation=eyes.rotation[e], position=eyes.translation[e]) @ imu_from_rig.inverse() for e in range(2)]
    return Eyes(np.stack([p.rotation for p in poses]), np.stack([p.position for p in poses]))


def _followed(
    robot: RobotDescription,
    calibration: StereoCalibration,
    true: Eyes,
    believed: Eyes,
    config: WindowConfig,
    sway: float = 3.0,
) -> SlidingWindow:
    random = np.random.default_rng(5)
    walk, mount = Walk(sway=sway), robot.imu.body_from_imu
    ground = Ground(calibration, true, random, features=80)
    window = SlidingWindow(believed, robot.imu, calibration.left.fx, OdometryConfig(window=config))
    start = walk.body(0.5) @ mount
    samples = as_samples(inertia(walk, robot, 0, 10 * FRAME_NS, random, GYRO_BIAS, ACCEL_BIAS))
    begin_window(window, robot, start, samples, 10 * FRAME_NS)
    window.see(ground.tracks(start))
    for k in range(11, round(SECONDS * 1e9) // FRAME_NS):
        samples = as_samples(inertia(walk, robot, (k - 1) * FRAME_NS, k * FRAME_NS, random, GYRO_BIAS, ACCEL_BIAS))
        tracks = ground.tracks(walk.body(k * FRAME_NS * 1e-9) @ mount)
        rate = samples[-1, 1:4] - window.frames.gyro_bias[window.newest]
        window.add_frame(k * FRAME_NS, samples, rate, tracks, resting=False)
        solved, wrong = window.optimise()
        assert solved
        ground.forget(wrong)
    return window


@pytest.mark.parametrize(
    ("config", "turn_left", "shift_left"),
    [(WindowConfig(), 0.8, 0.9), (WindowConfig(rig_turn_sigma=0.005, rig_shift_sigma=0.002), 0.4, 0.7)],
    ids=["a calibration that is trusted", "one that is doubted"],
)
def test_a_rig_that_was_knocked_is_found_out_in_part(
    robot: RobotDescription,
    calibration: StereoCalibration,
    eyes: Eyes,
    config: WindowConfig,
    turn_left: float,
    shift_left: float,
) -> None:
    knocked = Pose(rotation=rotation_exp(np.radians([0.2, -0.2, 0.1])), position=np.array([0.0012, 0.0012, -0.0011]))
    mounting = _followed(robot, calibration, _moved(eyes, knocked), eyes, config, sway=6.0).mounting()
    turn, whole = rotation_log(mounting.rotation.T @ knocked.rotation), rotation_log(knocked.rotation)
    assert np.linalg.norm(turn) < turn_left * np.linalg.norm(whole)
    assert np.linalg.norm(mounting.position - knocked.position) < shift_left * np.linalg.norm(knocked.position)


def test_a_rig_that_sits_right_is_left_alone(
    robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes
) -> None:
    mounting = _followed(robot, calibration, eyes, eyes, WindowConfig()).mounting()
    assert np.degrees(np.linalg.norm(rotation_log(mounting.rotation))) < 0.05
    assert np.linalg.norm(mounting.position) < 3e-4


def test_a_rig_whose_place_is_given_stays_there(
    robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes
) -> None:
    window = _followed(robot, calibration, eyes, eyes, WindowConfig(rig_turn_sigma=0.0, rig_shift_sigma=0.0))
    assert window.mounting().rotation == pytest.approx(np.eye(3), abs=1e-9)
    assert window.mounting().position == pytest.approx(np.zeros(3), abs=1e-9)
