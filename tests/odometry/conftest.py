"""The described robot with its ideal cameras."""

import numpy as np
import pytest

from robot_agent.odometry.landmarks import Eyes
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.robots import RobotDescription, load_robot


@pytest.fixture(scope="session")
def robot() -> RobotDescription:
    return load_robot("weaver")


@pytest.fixture(scope="session")
def calibration(robot: RobotDescription) -> StereoCalibration:
    return StereoCalibration.of_robot(robot)


@pytest.fixture(scope="session")
def eyes(robot: RobotDescription, calibration: StereoCalibration) -> Eyes:
    poses = [c.body_from_camera.inverse() @ robot.imu.body_from_imu for c in (calibration.left, calibration.right)]
    return Eyes(np.stack([p.rotation for p in poses]), np.stack([p.position for p in poses]))
