"""Impedance of a foot along gravity: -F = m x'' + b x' + c x (ICRA'17 eq. 6), discretised exactly.

Over a tick the force is constant, so the step is x+ = A x + B F with A = exp(M dt), M = [[0, 1], [-c/m, -b/m]]; the
response is the same at any control rate. Offsets are positive upwards: a foot pressed harder than expected gives way.
"""

from math import cos, cosh, exp, sin, sinh, sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def transition(mass: float, damping: float, stiffness: float, dt: float, step: Array) -> None:
    """Fill `step` (2, 3): the transition matrix of (x, x') and, in the last column, the response to 1 N."""
    decay = -0.5 * damping / mass
    square = decay * decay - stiffness / mass
    if square > 1e-12:
        root = sqrt(square)
        even, odd = cosh(root * dt), sinh(root * dt) / root
    elif square < -1e-12:
        root = sqrt(-square)
        even, odd = cos(root * dt), sin(root * dt) / root
    else:
        even, odd = 1.0, dt
    fade = exp(decay * dt)
    step[0, 0] = fade * (even - decay * odd)
    step[0, 1] = fade * odd
    step[1, 0] = -fade * odd * stiffness / mass
    step[1, 1] = fade * (even + decay * odd)
    step[0, 2] = (1.0 - step[0, 0]) / stiffness
    step[1, 2] = -step[1, 0] / stiffness


@kernel
def step_admittance(state: Array, force: Array, step: Array, largest_force: float, largest_offset: float) -> None:
    """Advance `state` (legs, 2), offset m and its rate, by one tick under `force` (legs,) N, in place.

    An offset held at its bound keeps no speed, so it leaves the bound as soon as the force turns.
    """
    for leg in range(state.shape[0]):
        x, v = state[leg, 0], state[leg, 1]
        felt = min(max(force[leg], -largest_force), largest_force)
        offset = step[0, 0] * x + step[0, 1] * v + step[0, 2] * felt
        rate = step[1, 0] * x + step[1, 1] * v + step[1, 2] * felt
        if abs(offset) > largest_offset:
            offset = largest_offset if offset > 0.0 else -largest_offset
            rate = 0.0
        state[leg, 0], state[leg, 1] = offset, rate
