"""What the feet bear, from the torques of the joints above them."""

import numpy as np
from numpy.typing import NDArray

from weaver_shared.robots.description import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body

Array = NDArray[np.float64]


def foot_jacobians(robot: RobotDescription, joint_position: Array) -> Array:
    """Motion of every foot in body by its leg's joints, (legs, 3, joints_per_leg) in m per rad."""
    frames = joint_frames_in_body(robot, joint_position)
    axes = frames[:, :-1, :3, 2] * robot.sides[:, None, None]
    levers = frames[:, -1:, :3, 3] - frames[:, :-1, :3, 3]
    return np.asarray(np.swapaxes(np.cross(axes, levers), 1, 2))


def foot_loads(robot: RobotDescription, joint_position: Array, joint_torque: Array, up_in_body: Array) -> Array:
    """Force (legs,) in N with which the ground lifts every foot, along `up_in_body` (3,).

    The joints' torques (joint_count,) in N m are balanced by a force at the foot alone; the leg's own weight, some 8 N
    on Weaver, is left out.
    """
    torque = np.asarray(joint_torque, dtype=np.float64).reshape(robot.leg_count, robot.joints_per_leg)
    forces = np.einsum("lij,li->lj", np.linalg.pinv(foot_jacobians(robot, joint_position)), -torque)
    return np.asarray(forces @ up_in_body)
