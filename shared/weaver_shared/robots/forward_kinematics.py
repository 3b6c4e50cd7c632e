"""Where a robot's links are: classical Denavit-Hartenberg chains, all legs at once."""

import numpy as np
from numpy.typing import NDArray

from weaver_shared.robots.description import RobotDescription

Array = NDArray[np.float64]


def joint_frames_in_body(robot: RobotDescription, joint_position: Array) -> Array:
    """Frames along every leg as homogeneous matrices, (legs, joints_per_leg + 1, 4, 4).

    Entry 0 is the hip; entry i is the frame after joint i, so the last one is the foot. `joint_position` is
    (joint_count,) or (legs, joints_per_leg) in rad. All frames are right-handed: those of a mirrored leg have y turned
    round, and their joints turn about -z.
    """
    legs, joints = robot.leg_count, robot.joints_per_leg
    angles = np.asarray(joint_position, dtype=np.float64).reshape(legs, joints)
    frames = np.zeros((legs, joints + 1, 4, 4))
    frames[:, 0] = _hips(robot)
    steps = _dh(robot.dh, angles)
    for index in range(joints):
        np.matmul(frames[:, index], steps[:, index], out=frames[:, index + 1])
    frames[:, :, :3, 1] *= robot.sides[:, None, None]
    return frames


def feet_in_body(robot: RobotDescription, joint_position: Array) -> Array:
    """Foot centres, (legs, 3) in metres."""
    feet: Array = joint_frames_in_body(robot, joint_position)[:, -1, :3, 3]
    return feet


def _hips(robot: RobotDescription) -> Array:
    result = np.zeros((robot.leg_count, 4, 4))
    result[:, :3, :3] = robot.hip_axes
    result[:, :3, 3] = robot.hips_in_body
    result[:, 3, 3] = 1.0
    return result


def _dh(rows: Array, angles: Array) -> Array:
    """RotZ(theta + q) TransZ(d) TransX(r) RotX(alpha) of `rows` (joints, 4) at `angles` (legs, joints)."""
    theta, d, r, alpha = rows.T
    ct, st = np.cos(theta + angles), np.sin(theta + angles)
    ca, sa = np.cos(alpha), np.sin(alpha)
    result = np.zeros((*angles.shape, 4, 4))
    result[..., 0, 0], result[..., 0, 1], result[..., 0, 2], result[..., 0, 3] = ct, -st * ca, st * sa, r * ct
    result[..., 1, 0], result[..., 1, 1], result[..., 1, 2], result[..., 1, 3] = st, ct * ca, -ct * sa, r * st
    result[..., 2, 1], result[..., 2, 2], result[..., 2, 3] = sa, ca, d
    result[..., 3, 3] = 1.0
    return result
