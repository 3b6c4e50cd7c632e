"""Joint angles that put feet at places, in plain numpy: for checks and start postures, not for control loops."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.robots.description import RobotDescription
from weaver_shared.robots.forward_kinematics import feet_in_body, joint_frames_in_body

Array = NDArray[np.float64]

TOLERANCE = 1e-5
"""Of the leg's length."""
LARGEST_STEP = 0.2  # rad
HOMING = 0.3


def joints_reaching(robot: RobotDescription, feet: Array, begin: Array, *, steps: int = 150) -> tuple[Array, Array]:
    """Joint angles (legs, joints) that put foot centres at `feet` (legs, 3) in body, and distances left (legs,), m.

    Damped least squares within the limits for walking from `begin` (legs, joints), which also settles what a surplus of
    joints leaves open.
    """
    lower, upper = robot.walking_limits.T
    joints = np.clip(begin, lower, upper)
    best, left = joints.copy(), np.full(robot.leg_count, np.inf)
    size = leg_length(robot)
    freedom = np.minimum(upper - lower, 1.0)  # a joint that can hardly move is not counted on
    for _ in range(steps):
        error = feet - feet_in_body(robot, joints)
        distance = np.linalg.norm(error, axis=1)
        nearer = distance < left - 1e-12
        best[nearer], left[nearer] = joints[nearer], distance[nearer]
        if float(left.max()) < TOLERANCE * size:
            break
        jacobian = foot_jacobians(robot, joints) * freedom
        transposed = np.swapaxes(jacobian, 1, 2)
        inverse = transposed @ np.linalg.inv(jacobian @ transposed + 1e-4 * size**2 * np.eye(3))
        free = np.eye(robot.joints_per_leg) - inverse @ jacobian
        step = (freedom[:, None] * inverse @ error[..., None] + HOMING * free @ (begin - joints)[..., None])[..., 0]
        joints = np.clip(joints + np.clip(step, -LARGEST_STEP, LARGEST_STEP), lower, upper)
    return best, left


def foot_jacobians(robot: RobotDescription, joints: Array) -> Array:
    """Foot velocity in body over joint rates, (legs, 3, joints)."""
    frames = joint_frames_in_body(robot, joints)
    axes = frames[:, :-1, :3, 2] * robot.sides[:, None, None]
    arms = frames[:, -1:, :3, 3] - frames[:, :-1, :3, 3]
    return np.swapaxes(np.cross(axes, arms), 1, 2)


def leg_length(robot: RobotDescription) -> float:
    """Length of the stretched chain, m."""
    return float(np.hypot(robot.dh[:, 1], robot.dh[:, 2]).sum())
