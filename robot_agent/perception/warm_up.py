"""Compiles what perception needs, so that no loop has to."""

from __future__ import annotations

import numpy as np

from robot_agent.perception.ground_plane import fit_plane
from robot_agent.perception.terrain import TerrainPerception
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.messages import OdometryEstimate, StereoFrame
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose


def warm_up() -> None:
    """Run perception once on a pair of pictures of noise."""
    robot = load_robot()
    picture = np.random.default_rng(0).integers(0, 255, (robot.camera.height, robot.camera.width), dtype=np.uint8)
    frame = StereoFrame(stamp_ns=0, sequence=0, left=picture, right=np.roll(picture, -20, axis=1))
    odometry = OdometryEstimate.at_rest(Pose.of([0.0, 0.0, robot.clearance]))
    x, y = np.random.default_rng(0).uniform(-1.0, 1.0, (2, 50))
    fit_plane(x, y, 0.1 * x, "robust")  # the noise above may not have shown any ground
    TerrainPerception(StereoCalibration.of_robot(robot)).step(frame, odometry)
