"""Ground forces on the feet from joint torques: tau = -J^T F + gravity of the links."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.chain import solve_symmetric
from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]

GRAVITY = 9.80665
DAMPING = 1e-5
"""m^2, keeps a stretched leg from answering with endless forces."""


@kernel
def link_gravity_torque(origins: Array, axes: Array, link_mass: Array, gravity_in_body: Array, torque: Array) -> None:
    """Fill `torque` (n,) N m that the servos of one leg spend on holding its own links.

    A link's mass sits half-way between its joint and the next; `gravity_in_body` (3,) is the unit vector downwards.
    """
    n = axes.shape[0]
    for i in range(n):
        torque[i] = 0.0
        for j in range(i, n):
            rx = 0.5 * (origins[j, 0] + origins[j + 1, 0]) - origins[i, 0]
            ry = 0.5 * (origins[j, 1] + origins[j + 1, 1]) - origins[i, 1]
            rz = 0.5 * (origins[j, 2] + origins[j + 1, 2]) - origins[i, 2]
            gx, gy, gz = gravity_in_body[0], gravity_in_body[1], gravity_in_body[2]
            moment = (
                axes[i, 0] * (ry * gz - rz * gy) + axes[i, 1] * (rz * gx - rx * gz) + axes[i, 2] * (rx * gy - ry * gx)
            )
            torque[i] -= link_mass[j] * GRAVITY * moment


@kernel
def foot_force(jacobian: Array, joint_torque: Array, own_torque: Array, force: Array) -> None:
    """Fill `force` (3,) N in body, ground on foot, from the servo torques (n,) N m of a leg.

    `jacobian` is (3, n), `own_torque` (n,) what the links need. Damped least squares over the joints:
    F = -(J J^T + damping)^-1 J (tau - tau_gravity).
    """
    n = joint_torque.size
    normal, right = np.empty((3, 3)), np.empty(3)
    for a in range(3):
        right[a] = 0.0
        for i in range(n):
            right[a] -= jacobian[a, i] * (joint_torque[i] - own_torque[i])
        for b in range(3):
            normal[a, b] = DAMPING if a == b else 0.0
            for i in range(n):
                normal[a, b] += jacobian[a, i] * jacobian[b, i]
    if not solve_symmetric(normal, right, force):
        force[0], force[1], force[2] = 0.0, 0.0, 0.0
