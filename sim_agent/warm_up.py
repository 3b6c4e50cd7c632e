"""Compiles what the simulator needs, so that no loop waits for the compiler."""

import numpy as np

from robot_agent.body import JointTargets
from sim_agent.sensors.inertial import disturb, interval_means
from sim_agent.servos import ServoBank
from sim_agent.worlds import make_world
from weaver_shared.robots import load_robot


def warm_up() -> None:
    robot = load_robot()
    joints = np.zeros(robot.joint_count)
    bank = ServoBank(robot, 1e-3)
    bank.command(JointTargets(stamp_ns=0, position=joints, torque_limit=joints, torque_on=True))
    bank.torque(joints, joints, joints.copy())
    sample, bias = np.zeros((2, 3)), np.zeros((2, 3))
    interval_means(np.eye(3), np.eye(3), np.zeros(3), np.zeros(3), 1e-3, sample)
    disturb(sample, bias, np.zeros((4, 3)), np.zeros(2), np.zeros(2))
    make_world("outdoor", 0).elevation(0.0, 0.0)
