"""Where in the stride to begin, so that feet left anywhere by the last stop do not run out of their range."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.stride import stride_of

Array = NDArray[np.float64]

AT_ONCE = 1e-9


@kernel
def best_start(place: Array, stance: Array, velocity: Array, offset: Array, duty: float, frequency: float) -> float:
    """Common phase, one of those at which a leg lifts, after which no foot strays far before its own first swing."""
    stride = np.empty(3)
    best, best_cost = 0.0, np.inf
    for candidate in range(offset.size):
        phase = (1.0 - offset[candidate]) % 1.0
        cost = 0.0
        for leg in range(offset.size):
            own = (phase + offset[leg]) % 1.0
            left = 0.0 if own < AT_ONCE or own > 1.0 - AT_ONCE else 1.0 - own
            stride_of(velocity, stance[leg], duty, frequency, stride)
            x = place[leg, 0] - stance[leg, 0] - stride[0] * left / duty
            y = place[leg, 1] - stance[leg, 1] - stride[1] * left / duty
            cost = max(cost, x * x + y * y)
        if cost < best_cost - 1e-12:
            best, best_cost = phase, cost
    return best


@kernel
def overrun(mode: NDArray[np.int64], place: Array, stance: Array, velocity: Array, half_stride: float) -> float:
    """How far, in half strides, the farthest foot on the ground is from its stance while being left behind further."""
    worst = 0.0
    for leg in range(mode.size):
        if mode[leg] == 1:
            continue
        x, y = place[leg, 0] - stance[leg, 0], place[leg, 1] - stance[leg, 1]
        along = -velocity[0] + velocity[2] * stance[leg, 1], -velocity[1] - velocity[2] * stance[leg, 0]
        if x * along[0] + y * along[1] > 0.0:
            worst = max(worst, np.sqrt(x * x + y * y) / half_stride)
    return worst
