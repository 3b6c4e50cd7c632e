"""Inverse kinematics by damped least squares, for any chain and for closed-form legs near their limits."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.chain import foot_jacobian, leg_frames, solve_symmetric
from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]

DAMPING = 1e-3
"""Damping over the stretched leg length; relative, so that small robots do not lag behind large ones."""
ITERATIONS = 24
ALIGNED_ITERATIONS = 14
"""After these the foot's place alone counts: near joint limits both can not be had."""
ALIGNMENT_GAIN = 0.3


@kernel
def solve_damped(
    dh: Array,
    limits: Array,
    hip_in_body: Array,
    hip_axes: Array,
    foot_in_body: Array,
    direction: Array,
    tolerance: float,
    solution: Array,
) -> float:
    """Move `solution` (n,), the starting guess, to the foot within the joint limits; returns the distance left, m.

    With more than three joints the last link turns towards `direction` as far as the foot position allows. A joint that
    ran into its limit is left out of the next step, which the others then take alone.
    """
    n = dh.shape[0]
    origins, axes, jacobian = np.empty((n + 1, 3)), np.empty((n, 3)), np.empty((3, n))
    normal, error, step, align = np.empty((3, 3)), np.empty(3), np.zeros(3), np.zeros(n)
    reach = np.abs(dh[:, 1:3]).sum()
    best, best_solution = 1e9, solution.copy()
    damping = (DAMPING * reach) ** 2
    stopped = np.zeros(n, dtype=np.bool_)
    for iteration in range(ITERATIONS):
        leg_frames(dh, hip_in_body, hip_axes, solution, origins, axes)
        for k in range(3):
            error[k] = foot_in_body[k] - origins[n, k]
        left = sqrt(error[0] ** 2 + error[1] ** 2 + error[2] ** 2)
        if left < best:
            best = left
            best_solution[:] = solution
        if left < tolerance:
            break
        if left > 0.25 * reach:
            error *= 0.25 * reach / left
        foot_jacobian(origins, axes, jacobian)
        align[:] = 0.0
        if n > 3 and iteration < ALIGNED_ITERATIONS:
            _alignment(origins, axes, direction, align)
        _leave_out(stopped, jacobian, align, error)
        _normal_matrix(jacobian, damping, normal)
        if not solve_symmetric(normal, error, step):
            break
        for i in range(n):
            change = align[i] + jacobian[0, i] * step[0] + jacobian[1, i] * step[1] + jacobian[2, i] * step[2]
            wanted = solution[i] + change
            solution[i] = min(max(wanted, limits[i, 0]), limits[i, 1])
            stopped[i] = wanted != solution[i]
    solution[:] = best_solution
    return best


@kernel
def _leave_out(stopped: NDArray[np.bool_], jacobian: Array, align: Array, error: Array) -> None:
    """Take the stopped joints out of the step, and what the alignment moves the foot by out of the error."""
    for i in range(align.size):
        if stopped[i]:
            align[i] = 0.0
        for k in range(3):
            if stopped[i]:
                jacobian[k, i] = 0.0
            error[k] -= jacobian[k, i] * align[i]


@kernel
def _normal_matrix(jacobian: Array, damping: float, normal: Array) -> None:
    for a in range(3):
        for b in range(3):
            normal[a, b] = damping if a == b else 0.0
            for i in range(jacobian.shape[1]):
                normal[a, b] += jacobian[a, i] * jacobian[b, i]


@kernel
def _alignment(origins: Array, axes: Array, direction: Array, align: Array) -> None:
    """Joint steps that turn the last link towards `direction`: its rotation error seen along each joint axis."""
    n = axes.shape[0]
    lx, ly, lz = origins[n] - origins[n - 1]
    length = sqrt(lx * lx + ly * ly + lz * lz)
    if length == 0.0:
        return
    ex = (ly * direction[2] - lz * direction[1]) / length
    ey = (lz * direction[0] - lx * direction[2]) / length
    ez = (lx * direction[1] - ly * direction[0]) / length
    for i in range(n):
        align[i] = ALIGNMENT_GAIN * (axes[i, 0] * ex + axes[i, 1] * ey + axes[i, 2] * ez)
