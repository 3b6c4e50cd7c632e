"""Where in the stride to begin, so that feet left anywhere by the last stop do not run out of their range."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import SWING
from robot_agent.locomotion.stride import stride_of
from robot_agent.locomotion.walk_state import Record

AT_ONCE = 1e-9


@kernel
def best_start(walk: Record) -> float:
    """Common phase, one of those at which a leg lifts, after which no foot strays far before its own first swing."""
    legs, orders, stance, place = walk.model.legs, walk.orders, walk.feet.stance, walk.feet.place
    stride = np.empty(3)
    best, best_cost = 0.0, np.inf
    for candidate in range(legs):
        phase = (1.0 - orders.offset[candidate]) % 1.0
        cost = 0.0
        for leg in range(legs):
            own = (phase + orders.offset[leg]) % 1.0
            left = 0.0 if own < AT_ONCE or own > 1.0 - AT_ONCE else 1.0 - own
            stride_of(orders.velocity, stance[leg], orders.duty, walk.gait.frequency, stride)
            x = place[leg, 0] - stance[leg, 0] - stride[0] * left / orders.duty
            y = place[leg, 1] - stance[leg, 1] - stride[1] * left / orders.duty
            cost = max(cost, x * x + y * y)
        if cost < best_cost - 1e-12:
            best, best_cost = phase, cost
    return best


@kernel
def overrun(walk: Record) -> float:
    """How far, in half strides, the farthest foot on the ground is from its stance while being left behind further."""
    velocity, stance, place = walk.gait.velocity, walk.feet.stance, walk.feet.place
    worst, half_stride = 0.0, 0.5 * walk.settings.largest_stride
    for leg in range(walk.model.legs):
        if walk.feet.mode[leg] == SWING:
            continue
        x, y = place[leg, 0] - stance[leg, 0], place[leg, 1] - stance[leg, 1]
        along = -velocity[0] + velocity[2] * stance[leg, 1], -velocity[1] - velocity[2] * stance[leg, 0]
        if x * along[0] + y * along[1] > 0.0:
            worst = max(worst, np.sqrt(x * x + y * y) / half_stride)
    return worst
