"""The velocity really walked: within every leg's stride, within the largest speed, and without jumps."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.reasons import STRIDE, VELOCITY
from robot_agent.locomotion.walk_state import Array, Record
from robot_agent.locomotion.workspace import velocity_scale

STILL = 1e-4
"""m/s or rad/s under which a command means stop."""
TURN_RADIUS = 0.4
"""m, about a foot's distance from the middle: weighs turning against translation."""


@kernel
def follow_velocity(walk: Record) -> None:
    """Bring the commanded velocity nearer to the ordered one, within what the legs can do."""
    gait, settings = walk.gait, walk.settings
    if limit_velocity(walk) < 0.999:
        walk.answer.reasons |= STRIDE
    speed_up, slow_down = settings.largest_speed / settings.start_time, settings.largest_speed / settings.stop_time
    approach(gait.commanded, gait.limited, speed_up, slow_down, walk.model.dt)


@kernel
def limit_velocity(walk: Record) -> float:
    """Shorten the ordered velocity (vx, vy, turn) to what the legs can do; returns the factor applied."""
    legs, gait, settings = walk.model.legs, walk.gait, walk.settings
    wanted, result = walk.orders.velocity, gait.limited
    size = np.sqrt(wanted[0] ** 2 + wanted[1] ** 2 + (TURN_RADIUS * wanted[2]) ** 2)
    scale = 1.0 if size <= settings.largest_speed else settings.largest_speed / size
    for k in range(3):
        result[k] = scale * wanted[k]
    further = velocity_scale(
        result, walk.feet.stance[:legs], walk.model.radius, gait.duty, gait.frequency, settings.largest_stride
    )
    for k in range(3):
        result[k] *= further
    return scale * further


@kernel
def approach(current: Array, target: Array, speed_up: float, slow_down: float, dt: float) -> None:
    """Move `current` (3,) towards `target` in place, by at most `speed_up` or, when slowing, `slow_down` m/s^2."""
    dx, dy, dw = target[0] - current[0], target[1] - current[1], TURN_RADIUS * (target[2] - current[2])
    gap = np.sqrt(dx * dx + dy * dy + dw * dw)
    now = current[0] ** 2 + current[1] ** 2 + (TURN_RADIUS * current[2]) ** 2
    then = target[0] ** 2 + target[1] ** 2 + (TURN_RADIUS * target[2]) ** 2
    step = (slow_down if then < now else speed_up) * dt
    share = 1.0 if gap <= step else step / gap
    for k in range(3):
        current[k] += share * (target[k] - current[k])


@kernel
def clean_velocity(walk: Record) -> None:
    """An order that is not a number, and one that is hardly any velocity, mean stop."""
    velocity = walk.orders.velocity
    largest = 0.0
    for k in range(3):
        if not np.isfinite(velocity[k]):
            walk.answer.reasons |= VELOCITY
            velocity[:] = 0.0
            return
        largest = max(largest, abs(velocity[k]))
    if largest <= STILL:
        velocity[:] = 0.0
