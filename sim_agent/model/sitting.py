"""Joint angles of a robot that sits: belly on the ground, feet on the ground where they will stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import feet_in_body

Array = NDArray[np.float64]

KNEES_UP = (0.0, 0.0, -1.4, 1.1, 1.75)
"""Where the search begins (rad): folded upwards, since the hips lie as low as the feet."""

TOLERANCE = 1e-4  # m


def sitting_joints(robot: RobotDescription) -> Array:
    """Joint angles (joints,) in rad that put every foot centre one foot radius over the belly's plane.

    Damped least squares on numerical Jacobians; the surplus of joints is settled by staying near the folded pose.
    Raises ConfigurationError when the legs can not reach.
    """
    lower, upper = (np.tile(robot.joint_limits[:, side], robot.leg_count) for side in (0, 1))
    folded = np.zeros(robot.joints_per_leg)
    folded[: len(KNEES_UP)] = KNEES_UP[: robot.joints_per_leg]
    preferred = np.clip(np.tile(folded, robot.leg_count), lower, upper)
    goal = robot.stance_in_body.copy()
    goal[:, 2] = robot.foot_radius
    joints = preferred.copy()
    for _ in range(100):
        error = goal - feet_in_body(robot, joints)
        if float(np.abs(error).max()) < TOLERANCE:
            return joints
        jacobian = _jacobians(robot, joints)  # (legs, 3, joints per leg)
        inverse = np.swapaxes(jacobian, 1, 2) @ np.linalg.inv(jacobian @ np.swapaxes(jacobian, 1, 2) + 1e-5 * np.eye(3))
        free = np.eye(robot.joints_per_leg) - inverse @ jacobian
        home = (preferred - joints).reshape(robot.leg_count, -1)
        step = (inverse @ error[..., None] + 0.3 * free @ home[..., None])[..., 0]
        joints = np.clip(joints + np.clip(step.reshape(-1), -0.2, 0.2), lower, upper)
    raise ConfigurationError(f"robot {robot.name!r} can not sit: its feet do not reach the ground at their stance")


def _jacobians(robot: RobotDescription, joints: Array) -> Array:
    """Foot positions by joint angles, (legs, 3, joints_per_leg), by central differences; legs are independent."""
    step = 1e-6
    columns = []
    for index in range(robot.joints_per_leg):
        offset = np.zeros((robot.leg_count, robot.joints_per_leg))
        offset[:, index] = step
        ahead = feet_in_body(robot, joints + offset.reshape(-1))
        behind = feet_in_body(robot, joints - offset.reshape(-1))
        columns.append((ahead - behind) / (2.0 * step))
    return np.stack(columns, axis=-1)
