"""Begins what was ordered. All that is heavy is loaded with this module: only once somebody calibrates."""

from __future__ import annotations

from pathlib import Path

import cv2

from robot_agent.calibration.camera_session import CameraSession
from robot_agent.calibration.guided_inertial import GuidedInertial
from robot_agent.calibration.guided_session import GuidedSession
from robot_agent.calibration.inertial_session import InertialSession
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.session_orders import SessionOrder
from robot_agent.vision.camchain import read_chain
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.errors import InputError
from weaver_shared.robots import RobotDescription

DESCRIPTION = "the robot's description"


def begin_session(order: SessionOrder, robot: RobotDescription, calibrations: Path) -> GuidedSession:
    """Raises InputError where the lenses it should go by are not those of a pair."""
    cv2.setNumThreads(1)
    pair = StereoCalibration.of_robot(robot)
    if order.part == "cameras":
        return CameraSession(order.target, Rig.of((pair.left, pair.right)))
    cameras, told_by = (pair.left, pair.right), DESCRIPTION
    if order.lenses:
        told_by = f"the calibration {order.lenses}"
        chain = read_chain(calibrations / order.lenses / "camchain.yaml")
        if len(chain.cameras) != 2:
            raise InputError(f"{told_by} is of {len(chain.cameras)} cameras, a pair is needed")
        cameras = (chain.cameras[0], chain.cameras[1])
    guided = GuidedInertial(order.target, Rig.of(cameras), told_by, robot.imu)
    return InertialSession(guided, robot.imu.body_from_imu.inverse() @ pair.left.body_from_camera)
