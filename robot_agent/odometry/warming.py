"""Compile the odometry's kernels ahead, by following a made-up textured ground for a few frames."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.estimator import StereoInertialOdometry
from robot_agent.odometry.own_legs import OwnLegs
from robot_agent.odometry.propagator import StatePropagator
from robot_agent.odometry.rotations import exponential
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import OdometryConfig, WindowConfig
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch, StereoFrame
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

FRAMES = 20
FOOTHOLDS = np.array([[0.3, 0.2, -0.15], [0.3, -0.2, -0.15], [-0.3, 0.0, -0.15]])  # m, in body


def warm_up() -> None:
    """Run every kernel once, so that none is compiled inside a running loop."""
    robot = load_robot("weaver")
    calibration = StereoCalibration.of_robot(robot)
    # Few keyframes and little patience: twenty frames pass through start, solving, dropping and marginalisation.
    config = OdometryConfig(window=WindowConfig(keyframes=3, keyframe_overlap=1.0, keyframe_interval=0.04))
    odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=Pose.identity(), config=config)
    propagator = StatePropagator(robot.imu, Pose.identity())
    texture = np.random.default_rng(0).integers(0, 255, (120, 200), dtype=np.uint8).repeat(5, axis=0).repeat(5, axis=1)
    legs = OwnLegs(joint_in_body=np.tile(FOOTHOLDS[:1], (1, 2, 1)), radius=0.03)
    height, width, disparity = calibration.left.height, calibration.left.width, 40
    for k in range(FRAMES):
        end = 50_000_000 * (k + 1)
        stamps = np.arange(end - 45_000_000, end + 1, 5_000_000, dtype=np.int64)
        imu = ImuBatch(
            stamp_ns=stamps,
            angular_velocity_in_imu=np.zeros((len(stamps), 3)),
            specific_force_in_imu=np.tile([0.0, 0.0, GRAVITY], (len(stamps), 1)),
        )
        left = np.ascontiguousarray(texture[:height, 60:][:, :width])
        right = np.ascontiguousarray(texture[:height, 60 + disparity :][:, :width])
        propagator.propagate(imu)
        frame = StereoFrame(stamp_ns=end, sequence=k, left=left, right=right)
        propagator.correct(odometry.step(frame, imu, _standing(stamps), legs))
    exponential(np.zeros(3))


def _standing(stamps: NDArray[np.int64]) -> FootContacts:
    count = len(stamps)
    return FootContacts(
        stamp_ns=stamps,
        foot_in_body=np.tile(FOOTHOLDS, (count, 1, 1)),
        sole_in_body=np.tile(FOOTHOLDS, (count, 1, 1)),
        touching=np.ones((count, len(FOOTHOLDS)), dtype=np.bool_),
    )
