"""Inverse kinematics of all legs: closed form where the chain has one, damped least squares otherwise."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.closed_form import solve_closed_form
from robot_agent.kinematics.compiled import kernel
from robot_agent.kinematics.damped import ITERATIONS, solve_damped
from robot_agent.kinematics.yaw_pitch import solve_yaw_pitch

Array = NDArray[np.float64]

TOLERANCE = 1e-6
"""Distance, m, at which the iteration is content."""
ITERATIVE, YAW_ROLL_PITCH, YAW_PITCH = 0, 1, 2
"""Which closed form a leg has."""


@kernel
def solve_leg(
    dh: Array,
    limits: Array,
    closed_form: int,
    hip_in_body: Array,
    hip_axes: Array,
    foot_in_body: Array,
    direction: Array,
    previous: Array,
    solution: Array,
) -> float:
    """Fill `solution` (n,) rad for one foot; returns the distance left, m. `previous` (n,) starts the iteration.

    A foot that is not finite leaves the joints where they were and returns infinity.
    """
    return solve_leg_to(
        dh, limits, closed_form, hip_in_body, hip_axes, foot_in_body, direction, TOLERANCE, ITERATIONS, previous,
        solution,
    )  # fmt: skip


@kernel
def solve_leg_to(
    dh: Array,
    limits: Array,
    closed_form: int,
    hip_in_body: Array,
    hip_axes: Array,
    foot_in_body: Array,
    direction: Array,
    tolerance: float,
    iterations: int,
    previous: Array,
    solution: Array,
) -> float:
    """`solve_leg` with so many `iterations` at most, content at a distance of `tolerance` m."""
    for k in range(3):
        if not (np.isfinite(foot_in_body[k]) and np.isfinite(direction[k])):
            solution[:] = previous
            return np.inf
    exact = False
    if closed_form == YAW_ROLL_PITCH:
        exact = solve_closed_form(dh, limits, hip_in_body, hip_axes, foot_in_body, direction, solution)
    elif closed_form == YAW_PITCH:
        exact = solve_yaw_pitch(dh, limits, hip_in_body, hip_axes, foot_in_body, previous, solution)
    if exact:
        return 0.0
    solution[:] = previous
    return solve_damped(dh, limits, hip_in_body, hip_axes, foot_in_body, direction, tolerance, iterations, solution)


@kernel
def solve_legs(
    dh: Array,
    limits: Array,
    closed_form: int,
    hips: Array,
    hip_axes: Array,
    feet_in_body: Array,
    direction: Array,
    previous: Array,
    solution: Array,
    distance_left: Array,
) -> None:
    """`solve_leg` for every leg: feet (legs, 3), joints (legs, n), `distance_left` (legs,)."""
    for leg in range(hips.shape[0]):
        distance_left[leg] = solve_leg(
            dh,
            limits,
            closed_form,
            hips[leg],
            hip_axes[leg],
            feet_in_body[leg],
            direction,
            previous[leg],
            solution[leg],
        )
