"""Ground forces on the feet from joint torques: tau = -J^T F + gravity of the links."""

import numpy as np
from numpy.typing import NDArray

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
    gx, gy, gz = GRAVITY * gravity_in_body[0], GRAVITY * gravity_in_body[1], GRAVITY * gravity_in_body[2]
    mass, sx, sy, sz = 0.0, 0.0, 0.0, 0.0  # of the links from joint i on: mass, and mass times place
    for i in range(axes.shape[0] - 1, -1, -1):
        half = 0.5 * link_mass[i]
        mass += link_mass[i]
        sx += half * (origins[i, 0] + origins[i + 1, 0])
        sy += half * (origins[i, 1] + origins[i + 1, 1])
        sz += half * (origins[i, 2] + origins[i + 1, 2])
        rx, ry, rz = sx - mass * origins[i, 0], sy - mass * origins[i, 1], sz - mass * origins[i, 2]
        torque[i] = (
            axes[i, 0] * (rz * gy - ry * gz) + axes[i, 1] * (rx * gz - rz * gx) + axes[i, 2] * (ry * gx - rx * gy)
        )


@kernel
def link_inertia_torque(origins: Array, axes: Array, link_mass: Array, acceleration: Array, torque: Array) -> None:
    """Fill `torque` (n,) N m that turn a leg's joints with `acceleration` (n,) rad/s^2 against its links' inertia.

    Links are points half-way between their joints; what grows with the square of the speed is left out.
    """
    n = axes.shape[0]
    linear, lever, turn = np.empty(3), np.empty(3), np.empty(3)
    torque[:n] = 0.0
    for j in range(n):
        linear[:] = 0.0
        for i in range(j + 1):
            _move_by(origins, axes, i, j, lever, turn)
            for k in range(3):
                linear[k] += turn[k] * acceleration[i]
        for i in range(j + 1):
            _move_by(origins, axes, i, j, lever, turn)
            torque[i] += link_mass[j] * (turn[0] * linear[0] + turn[1] * linear[1] + turn[2] * linear[2])


@kernel
def _move_by(origins: Array, axes: Array, joint: int, link: int, lever: Array, move: Array) -> None:
    """Fill `move` (3,) m/rad, how a link's middle moves with a joint; `lever` (3,) is from the one to the other."""
    for k in range(3):
        lever[k] = 0.5 * (origins[link, k] + origins[link + 1, k]) - origins[joint, k]
    move[0] = axes[joint, 1] * lever[2] - axes[joint, 2] * lever[1]
    move[1] = axes[joint, 2] * lever[0] - axes[joint, 0] * lever[2]
    move[2] = axes[joint, 0] * lever[1] - axes[joint, 1] * lever[0]


@kernel
def foot_force(jacobian: Array, joint_torque: Array, own_torque: Array, force: Array) -> None:
    """Fill `force` (3,) N in body, ground on foot, from the servo torques (n,) N m of a leg.

    `jacobian` is (3, n), `own_torque` (n,) what the links need. Damped least squares over the joints:
    F = -(J J^T + damping)^-1 J (tau - tau_gravity).
    """
    n00, n01, n02, n11, n12, n22 = DAMPING, 0.0, 0.0, DAMPING, 0.0, DAMPING
    rx, ry, rz = 0.0, 0.0, 0.0
    for i in range(joint_torque.size):
        jx, jy, jz = jacobian[0, i], jacobian[1, i], jacobian[2, i]
        given = own_torque[i] - joint_torque[i]
        rx, ry, rz = rx + jx * given, ry + jy * given, rz + jz * given
        n00, n01, n02 = n00 + jx * jx, n01 + jx * jy, n02 + jx * jz
        n11, n12, n22 = n11 + jy * jy, n12 + jy * jz, n22 + jz * jz
    c00, c01, c02 = n11 * n22 - n12 * n12, n02 * n12 - n01 * n22, n01 * n12 - n02 * n11
    c11, c12, c22 = n00 * n22 - n02 * n02, n01 * n02 - n00 * n12, n00 * n11 - n01 * n01
    scale = 1.0 / (n00 * c00 + n01 * c01 + n02 * c02)  # the damping keeps the determinant from zero
    force[0] = scale * (c00 * rx + c01 * ry + c02 * rz)
    force[1] = scale * (c01 * rx + c11 * ry + c12 * rz)
    force[2] = scale * (c02 * rx + c12 * ry + c22 * rz)
