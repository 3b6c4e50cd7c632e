"""Until odometry has found its first pose, the legs say how high the body is; from then on odometry does."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

from robot_agent.adaptation import ParameterOverrides
from robot_agent.orders import idle_orders
from robot_agent.pipeline import WalkPipeline
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch, OdometryEstimate, OdometryQuality, Proprioception
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.transforms import Pose

TICK_NS = 10_000_000


def _joints(robot: RobotDescription, lifted: float) -> np.ndarray:
    """Of a body that stands `lifted` m above its usual height."""
    feet = robot.stance_in_body - np.array([0.0, 0.0, lifted])
    start = np.full(robot.joint_count, 0.1)
    return np.asarray(least_squares(lambda q: (feet_in_body(robot, q) - feet).ravel(), start).x)


def _sensed(robot: RobotDescription, tick: int, joints: np.ndarray) -> Proprioception:
    stamp = tick * TICK_NS
    return Proprioception(
        stamp_ns=stamp,
        joint_position=joints,
        joint_velocity=np.zeros(robot.joint_count),
        joint_torque=np.zeros(robot.joint_count),
        joint_valid=np.ones(robot.joint_count, dtype=np.bool_),
        joint_temperature=np.full(robot.joint_count, 30.0),
        foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
        imu=ImuBatch(
            stamp_ns=np.array([stamp], dtype=np.int64),
            angular_velocity_in_imu=np.zeros((1, 3)),
            specific_force_in_imu=np.array([[0.0, 0.0, GRAVITY]]),
        ),
        battery_voltage=25.0,
        supply_current=1.0,
        motor_power=10.0,
    )


def test_a_body_that_rises_while_gravity_is_sought_is_known_to_rise() -> None:
    robot = load_robot("weaver")
    pipeline = WalkPipeline(robot, ParameterOverrides(robot.adaptation), 0.01)
    usual = robot.foot_radius - float(robot.stance_in_body[:, 2].min())

    def height(tick: int, lifted: float) -> float:
        walked = pipeline.step(_sensed(robot, tick, _joints(robot, lifted)), idle_orders())
        return float(walked.state.world_from_body.position[2])

    assert height(1, -0.04) == pytest.approx(usual - 0.04, abs=1e-3)
    seeking = OdometryEstimate.at_rest(Pose.of([0.0, 0.0, usual - 0.04]), TICK_NS)
    pipeline.correct(replace(seeking, quality=OdometryQuality.INITIALISING))
    assert height(2, 0.0) == pytest.approx(usual, abs=1e-3)
    pipeline.correct(OdometryEstimate.at_rest(Pose.of([0.0, 0.0, usual + 0.1]), 2 * TICK_NS))
    assert height(3, 0.0) == pytest.approx(usual + 0.1, abs=1e-3)
