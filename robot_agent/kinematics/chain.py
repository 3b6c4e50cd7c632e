"""One leg as a serial chain: joint frames, foot Jacobian and the foot force behind measured torques.

Classical Denavit-Hartenberg rows (theta, d, r, alpha): RotZ(theta + q) TransZ(d) TransX(r) RotX(alpha).
`weaver_shared.robots.forward_kinematics` is the readable form these kernels are tested against.
"""

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


def with_turns(dh: Array) -> Array:
    """Rows theta, d, r, alpha, (n, 4), with cos alpha and sin alpha, (n, 6), which no tick needs to compute again."""
    return np.column_stack([dh, np.cos(dh[:, 3]), np.sin(dh[:, 3])])


@kernel
def leg_frames(
    dh: Array, hip_in_body: Array, hip_axes: Array, joint_position: Array, origins: Array, axes: Array
) -> None:
    """Fill `origins` (n + 1, 3), joint origins and then the foot, and `axes` (n, 3), joint axes; both in body.

    `dh` is (n, 6), see `with_turns`; `joint_position` (n,) rad, `hip_in_body` (3,) m. `hip_axes` (3, 3) has the chain's
    first axes as columns, in body; those of a mirrored leg are left-handed, and its joints turn the other way about
    theirs.
    """
    xx, xy, xz = hip_axes[0, 0], hip_axes[1, 0], hip_axes[2, 0]
    yx, yy, yz = hip_axes[0, 1], hip_axes[1, 1], hip_axes[2, 1]
    zx, zy, zz = hip_axes[0, 2], hip_axes[1, 2], hip_axes[2, 2]
    side = zx * (xy * yz - xz * yy) + zy * (xz * yx - xx * yz) + zz * (xx * yy - xy * yx)
    px, py, pz = hip_in_body[0], hip_in_body[1], hip_in_body[2]
    for i in range(dh.shape[0]):
        origins[i, 0], origins[i, 1], origins[i, 2] = px, py, pz
        axes[i, 0], axes[i, 1], axes[i, 2] = side * zx, side * zy, side * zz
        c, s = cos(dh[i, 0] + joint_position[i]), sin(dh[i, 0] + joint_position[i])
        ca, sa = dh[i, 4], dh[i, 5]
        nx, ny, nz = c * xx + s * yx, c * xy + s * yy, c * xz + s * yz
        tx, ty, tz = -s * xx + c * yx, -s * xy + c * yy, -s * xz + c * yz
        d, r = dh[i, 1], dh[i, 2]
        px, py, pz = px + d * zx + r * nx, py + d * zy + r * ny, pz + d * zz + r * nz
        xx, xy, xz = nx, ny, nz
        yx, yy, yz = ca * tx + sa * zx, ca * ty + sa * zy, ca * tz + sa * zz
        zx, zy, zz = ca * zx - sa * tx, ca * zy - sa * ty, ca * zz - sa * tz
    n = dh.shape[0]
    origins[n, 0], origins[n, 1], origins[n, 2] = px, py, pz


@kernel
def all_leg_frames(dh: Array, hips: Array, hip_axes: Array, joint_position: Array, origins: Array, axes: Array) -> None:
    """`leg_frames` of every leg: `joint_position` (legs, n), `origins` (legs, n + 1, 3), `axes` (legs, n, 3)."""
    for leg in range(hips.shape[0]):
        leg_frames(dh, hips[leg], hip_axes[leg], joint_position[leg], origins[leg], axes[leg])


@kernel
def foot_jacobian(origins: Array, axes: Array, jacobian: Array) -> None:
    """Fill `jacobian` (3, n): foot velocity in body over joint rates, from the frames of one leg."""
    n = axes.shape[0]
    for i in range(n):
        rx, ry, rz = origins[n, 0] - origins[i, 0], origins[n, 1] - origins[i, 1], origins[n, 2] - origins[i, 2]
        jacobian[0, i] = axes[i, 1] * rz - axes[i, 2] * ry
        jacobian[1, i] = axes[i, 2] * rx - axes[i, 0] * rz
        jacobian[2, i] = axes[i, 0] * ry - axes[i, 1] * rx


@kernel
def solve_symmetric(m: Array, b: Array, x: Array) -> bool:
    """Solve the 3x3 system m x = b by cofactors; False, and x untouched, where m is singular."""
    a00, a01, a02, a11, a12, a22 = m[0, 0], m[0, 1], m[0, 2], m[1, 1], m[1, 2], m[2, 2]
    c00, c01, c02 = a11 * a22 - a12 * a12, a02 * a12 - a01 * a22, a01 * a12 - a02 * a11
    determinant = a00 * c00 + a01 * c01 + a02 * c02
    size = abs(a00) + abs(a11) + abs(a22)
    if not abs(determinant) > 1e-12 * size * size * size:
        return False
    c11, c12, c22 = a00 * a22 - a02 * a02, a01 * a02 - a00 * a12, a00 * a11 - a01 * a01
    x[0] = (c00 * b[0] + c01 * b[1] + c02 * b[2]) / determinant
    x[1] = (c01 * b[0] + c11 * b[1] + c12 * b[2]) / determinant
    x[2] = (c02 * b[0] + c12 * b[1] + c22 * b[2]) / determinant
    return True
