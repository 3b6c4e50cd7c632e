"""Ground forces on the feet from joint torques: tau = -J^T F + gravity of the links."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.chain import foot_jacobian, solve_symmetric
from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]

GRAVITY = 9.80665
DAMPING = 1e-4
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
def foot_forces(
    origins: Array, axes: Array, link_mass: Array, gravity_in_body: Array, joint_torque: Array, force: Array
) -> None:
    """Fill `force` (legs, 3) N in body, ground on foot, from servo torques (legs, n) N m.

    Damped least squares over the joints: F = -(J J^T + damping)^-1 J (tau - tau_gravity).
    """
    legs, n = axes.shape[0], axes.shape[1]
    jacobian, normal, right, solution = np.empty((3, n)), np.empty((3, 3)), np.empty(3), np.zeros(3)
    own = np.empty(n)
    for leg in range(legs):
        foot_jacobian(origins[leg], axes[leg], jacobian)
        link_gravity_torque(origins[leg], axes[leg], link_mass, gravity_in_body, own)
        for a in range(3):
            right[a] = 0.0
            for i in range(n):
                right[a] -= jacobian[a, i] * (joint_torque[leg, i] - own[i])
            for b in range(3):
                normal[a, b] = DAMPING if a == b else 0.0
                for i in range(n):
                    normal[a, b] += jacobian[a, i] * jacobian[b, i]
        if solve_symmetric(normal, right, solution):
            for a in range(3):
                force[leg, a] = solution[a]
        else:
            force[leg] = 0.0
