"""Compiles what the simulator needs, so that no loop waits for the compiler."""

import numpy as np

from robot_agent.body import JointTargets
from robot_agent.calibration.lens import camera_of
from robot_agent.calibration.target import AprilGrid
from sim_agent.sensors.inertial import disturb, interval_means
from sim_agent.servos import ServoBank
from sim_agent.targets.rendering import TargetRenderer
from sim_agent.worlds import make_world
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose


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
    lens = np.array([30.0, 30.0, 15.5, 11.5, 0.0, 0.0, 0.0, 0.0])
    grid = AprilGrid(columns=2, rows=2, tag_size=0.1, spacing=0.3)
    above = Pose(rotation=np.diag([1.0, -1.0, -1.0]), position=np.array([0.1, 0.1, 0.4]))
    TargetRenderer(grid, camera_of("none", lens, (32, 24))).draw([above], np.random.default_rng(0))
