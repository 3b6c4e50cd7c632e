"""Joint speed limits kept by a leg's further freedom: the same foot, with other joints taking over.

What a joint can turn to in one tick is a narrower range of it, so the limit avoidance of the damped least squares also
avoids speed limits. A foot that can not be had so is left to the shortening of the whole leg's step, along its path.
"""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.kinematics.damped import ITERATIONS, solve_damped

Array = NDArray[np.float64]


@kernel
def solve_within_speed(
    dh: Array,
    limits: Array,
    hip_in_body: Array,
    hip_axes: Array,
    foot_in_body: Array,
    direction: Array,
    tolerance: float,
    largest_step: Array,
    previous: Array,
    solution: Array,
) -> bool:
    """Replace `solution` (n,) by one within `largest_step` (n,) rad of `previous` (n,); False, and unchanged, if none.

    The other arguments are those of `solve_damped`.
    """
    n = previous.size
    box, found = np.empty((n, 2)), previous.copy()
    for i in range(n):
        box[i, 0] = max(limits[i, 0], previous[i] - largest_step[i])
        box[i, 1] = min(limits[i, 1], previous[i] + largest_step[i])
    left = solve_damped(dh, box, hip_in_body, hip_axes, foot_in_body, direction, tolerance, ITERATIONS, found)
    if left > tolerance:
        return False
    solution[:] = found
    return True


@kernel
def is_too_fast(previous: Array, wanted: Array, largest_step: Array) -> bool:
    """Whether any joint (n,) turns by more than `largest_step` (n,) rad."""
    worst = 0.0
    for i in range(previous.size):
        worst = max(worst, abs(wanted[i] - previous[i]) - largest_step[i])
    return worst > 0.0
