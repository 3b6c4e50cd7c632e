"""Compiles the walker's kernels, so that nothing is compiled inside a running loop."""

from __future__ import annotations

import numpy as np

from robot_agent.locomotion import openshc
from robot_agent.locomotion.ideal_walk import IdealWalk
from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posing.order import PosingOrder
from robot_agent.locomotion.posture_order import PostureOrder
from robot_agent.locomotion.postures import Postures
from robot_agent.locomotion.walk_tick import WalkInput
from robot_agent.locomotion.walker import Walker
from robot_agent.locomotion.yardstick import yardstick
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription, load_robot

WARMING_VELOCITY = np.array([0.1, 0.02, 0.05])
"""m/s, rad/s."""
TWO_POSTURES = "bullet_a_insectoid"


def warm_up(robot: RobotDescription | None = None) -> None:
    """Walk a robot (Weaver unless told otherwise) for a stride with and without ground contact, and OpenSHC's legs."""
    openshc.warm_up()
    yardstick(1)
    robot = robot or load_robot()
    for feel_ground in (True, False):
        tick = IdealWalk(robot, LocomotionConfig(feel_ground=feel_ground), velocity=WARMING_VELOCITY).replay(120)
        for _ in range(120):
            tick()
    pose_and_lift(robot)
    change_posture(load_robot(TWO_POSTURES))


def pose_and_lift(robot: RobotDescription) -> None:
    """Stand posed with a leg lifted, walk posed, sit down packed and stand up again: what walking leaves cold."""
    walker = Walker(robot)
    joints = walker.begin_standing()
    leg, posed = LegOrder(leg=0), PosingOrder(manual=(0.0, 0.0, 0.01, 0.02, 0.0, 0.0), automatic=True, levelling=True)
    for velocity, stand, legs, ticks in ((0.0, True, (leg,), 150), (0.05, True, (), 400), (0.0, False, (), 1500),
                                         (0.0, True, (), 20)):  # fmt: skip
        for _ in range(ticks):
            sensed = WalkInput(
                stamp_ns=0,
                velocity=np.array([velocity, 0.0, 0.0]),
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=1000.0, stride_frequency=1.0, stride_height=0.05, confidence=1.0
                ),
                gait=robot.gaits[0],
                stand=stand,
                joint_position=joints,
                joint_torque=np.full(robot.joint_count, 0.1),
                foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
                posing=posed,
                legs=legs,
                pack=True,
                in_sequence=True,
            )
            joints = walker.step(sensed).joint_position


def change_posture(robot: RobotDescription) -> None:
    """The first moments of a change of posture, in which feet glide and a leg is relieved."""
    legs = Postures(robot, dt=0.01)
    joints = legs.begin_standing()
    for _ in range(3):
        sensed = WalkInput(
            stamp_ns=0,
            velocity=np.zeros(3),
            parameters=GaitParameters(
                stamp_ns=0, virtual_stiffness=1000.0, stride_frequency=1.0, stride_height=0.05, confidence=1.0
            ),
            gait=robot.gaits[0],
            stand=True,
            joint_position=joints,
            joint_torque=np.full(robot.joint_count, 0.1),
            foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
            gravity_in_body=np.array([0.0, 0.0, -1.0]),
            posture_order=PostureOrder(name="mammalian", serial=1),
        )
        joints = legs.step(sensed).joint_position
