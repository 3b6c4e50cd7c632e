"""Inverse kinematics by damped least squares, for any chain and for closed-form legs near their limits.

The foot's place comes first. What a leg has of further freedom turns its last link as wanted and keeps its joints away
from their limits; both are descents of a cost inside the null space of the foot. Of these every call takes one step,
so that a leg glides to the best posture for its foot and rests there, however exactly the foot is placed. A joint near
a limit is weighted less and leaves its part to the others.
"""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.chain import foot_jacobian, leg_frames, solve_symmetric
from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]

DAMPING = 1e-3
"""Damping over the stretched leg length; relative, so that small robots do not lag behind large ones."""
LARGEST_ERROR = 0.25
"""Of the stretched leg length, that one step tries to undo."""
ITERATIONS = 24
"""Enough to reach whatever can be reached."""
ALIGNMENT_GAIN = 0.3
LARGEST_MISALIGNMENT = 0.1
"""rad (its sine) that the last link is turned by as if it were no more, so that joint limits weigh more."""
COMFORT = 0.8
"""Of the way from the middle of a joint's range to its limit, beyond which it is pushed back."""
AVOIDANCE_GAIN = 0.2
MARGIN = 0.1
"""Of a joint's range, from a limit, in which its weight falls."""
LEAST_WEIGHT = 0.1


@kernel
def solve_damped(
    dh: Array,
    limits: Array,
    hip_in_body: Array,
    hip_axes: Array,
    foot_in_body: Array,
    direction: Array,
    tolerance: float,
    iterations: int,
    solution: Array,
) -> float:
    """Move `solution` (n,), the starting guess, to the foot within the joint limits; returns the distance left, m.

    With more than three joints the last link turns towards `direction` as far as the foot position allows, by a step a
    call. A joint that ran into its limit is left out of the next step, which the others then take alone.
    """
    n = dh.shape[0]
    origins, axes, jacobian = np.empty((n + 1, 3)), np.empty((n, 3)), np.empty((3, n))
    normal, error, step = np.empty((3, 3)), np.empty(3), np.zeros(3)
    free, weight = np.zeros(n), np.empty(n)
    reach = np.abs(dh[:, 1:3]).sum()
    best, best_solution, start, at_start = np.inf, solution.copy(), solution.copy(), np.inf
    damping = (DAMPING * reach) ** 2
    stopped = np.zeros(n, dtype=np.bool_)
    for iteration in range(iterations):
        leg_frames(dh, hip_in_body, hip_axes, solution, origins, axes)
        for k in range(3):
            error[k] = foot_in_body[k] - origins[n, k]
        left = sqrt(error[0] * error[0] + error[1] * error[1] + error[2] * error[2])
        glides = n > 3 and iteration == 0
        if glides:
            at_start = left
        elif left < best:
            best = left
            best_solution[:] = solution
        if left < tolerance and not glides:
            break
        if left > LARGEST_ERROR * reach:
            error *= LARGEST_ERROR * reach / left
        foot_jacobian(origins, axes, jacobian)
        _weigh(limits, solution, stopped, weight)
        if glides:
            _align(origins, axes, direction, free)
            _avoid(limits, solution, free)
            _take_off(jacobian, weight, free, error)
        else:
            free[:] = 0.0
        _weighted_normal(jacobian, weight, damping, normal)
        if not solve_symmetric(normal, error, step):
            break
        for i in range(n):
            pull = jacobian[0, i] * step[0] + jacobian[1, i] * step[1] + jacobian[2, i] * step[2]
            wanted = solution[i] + free[i] + weight[i] * pull
            solution[i] = min(max(wanted, limits[i, 0]), limits[i, 1])
            stopped[i] = wanted != solution[i]
    if at_start < tolerance <= best or best == np.inf:  # rather the foot at its place than a better posture
        best = at_start
        best_solution[:] = start
    solution[:] = best_solution
    return best


@kernel
def _align(origins: Array, axes: Array, direction: Array, free: Array) -> None:
    """Fill `free` (n,) with steps that turn the last link towards `direction`: its rotation error along each axis."""
    n = axes.shape[0]
    lx, ly, lz = origins[n, 0] - origins[n - 1, 0], origins[n, 1] - origins[n - 1, 1], origins[n, 2] - origins[n - 1, 2]
    ex = ly * direction[2] - lz * direction[1]
    ey = lz * direction[0] - lx * direction[2]
    ez = lx * direction[1] - ly * direction[0]
    length, size = sqrt(lx * lx + ly * ly + lz * lz), sqrt(ex * ex + ey * ey + ez * ez)
    gain = ALIGNMENT_GAIN / max(length, size / LARGEST_MISALIGNMENT) if length > 0.0 else 0.0
    for i in range(n):
        free[i] = gain * (axes[i, 0] * ex + axes[i, 1] * ey + axes[i, 2] * ez)


@kernel
def _avoid(limits: Array, solution: Array, free: Array) -> None:
    """Add to `free` (n,) what moves joints in the outer part of their range back towards its middle."""
    for i in range(free.size):
        middle, half = 0.5 * (limits[i, 0] + limits[i, 1]), 0.5 * (limits[i, 1] - limits[i, 0])
        beyond = abs(solution[i] - middle) - COMFORT * half
        if beyond > 0.0:
            free[i] -= AVOIDANCE_GAIN * (beyond if solution[i] > middle else -beyond)


@kernel
def _weigh(limits: Array, solution: Array, stopped: NDArray[np.bool_], weight: Array) -> None:
    """Fill the joints' `weight` (n,): 1, less near a limit, zero for those that ran into it."""
    for i in range(weight.size):
        room = min(limits[i, 1] - solution[i], solution[i] - limits[i, 0])
        share = room / (MARGIN * (limits[i, 1] - limits[i, 0]))
        weight[i] = 0.0 if stopped[i] else min(max(share, LEAST_WEIGHT), 1.0)


@kernel
def _take_off(jacobian: Array, weight: Array, free: Array, error: Array) -> None:
    """Weight the `free` steps (n,) and take what they move the foot by out of the `error` (3,)."""
    for i in range(weight.size):
        free[i] *= weight[i]
        for k in range(3):
            error[k] -= jacobian[k, i] * free[i]


@kernel
def _weighted_normal(jacobian: Array, weight: Array, damping: float, normal: Array) -> None:
    """Fill the upper half of `normal` (3, 3), which is J W J^T + damping."""
    n00, n01, n02, n11, n12, n22 = damping, 0.0, 0.0, damping, 0.0, damping
    for i in range(weight.size):
        x, y, z, w = jacobian[0, i], jacobian[1, i], jacobian[2, i], weight[i]
        n00, n01, n02 = n00 + w * x * x, n01 + w * x * y, n02 + w * x * z
        n11, n12, n22 = n11 + w * y * y, n12 + w * y * z, n22 + w * z * z
    normal[0, 0], normal[0, 1], normal[0, 2] = n00, n01, n02
    normal[1, 1], normal[1, 2], normal[2, 2] = n11, n12, n22
