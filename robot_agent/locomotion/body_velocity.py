"""The velocity really walked: within every leg's stride, within the largest speed, and without jumps."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.body_speed import TURN_RADIUS, speed_of
from robot_agent.locomotion.feet import STAND
from robot_agent.locomotion.reasons import STRIDE, VELOCITY
from robot_agent.locomotion.walk_state import Array, Record
from robot_agent.locomotion.walkspace import largest_excursion, velocity_scale

STILL = 1e-4
"""m/s or rad/s under which a command means stop."""
HALVINGS = 5
"""Of a tick's change of velocity."""


@kernel
def follow_velocity(walk: Record) -> None:
    """Bring the commanded velocity nearer to the ordered one, within what the legs can do."""
    gait, settings = walk.gait, walk.settings
    if limit_velocity(walk) < 0.999:
        walk.answer.reasons |= STRIDE
    speed_up, slow_down = settings.largest_speed / settings.start_time, settings.largest_speed / settings.stop_time
    wanted = np.empty(3)
    wanted[:] = gait.commanded
    approach(wanted, gait.limited, speed_up, slow_down, walk.model.dt)
    keep_within_walkspace(walk, wanted)


@kernel
def keep_within_walkspace(walk: Record, wanted: Array) -> None:
    """Take as much of the change to `wanted` (3,) as leaves every standing foot in its walkspace until it lifts.

    This is the limit of acceleration: feet that were put down for a lower speed have less way left. A robot may always
    slow down.
    """
    gait, legs = walk.gait, walk.model.legs
    share, time_left = 1.0, np.zeros(legs)
    if gait.walking and speed_of(wanted) > speed_of(gait.commanded):
        for leg in range(legs):
            lifts_now = gait.leg_phase[leg] < 1.0 - gait.duty and not walk.feet.lifted[leg]
            if walk.feet.mode[leg] == STAND and not lifts_now:
                time_left[leg] = (1.0 - gait.leg_phase[leg]) / gait.frequency
        share = _affordable(walk, wanted, time_left)
    for k in range(3):
        gait.commanded[k] += share * (wanted[k] - gait.commanded[k])


@kernel
def _affordable(walk: Record, wanted: Array, time_left: Array) -> float:
    """The share 0..1 of the change to `wanted` that the feet's ways allow, found by halving."""
    gait, trial = walk.gait, np.empty(3)
    share, step = 1.0, 1.0
    allowed = max(1.0, _excursion(walk, gait.commanded, time_left)) + 1e-6
    for _ in range(HALVINGS):
        for k in range(3):
            trial[k] = gait.commanded[k] + share * (wanted[k] - gait.commanded[k])
        step *= 0.5
        if _excursion(walk, trial, time_left) > allowed:
            share -= step
        elif share == 1.0:
            return 1.0
        else:
            share += step
    return max(share - step, 0.0)


@kernel
def _excursion(walk: Record, velocity: Array, time_left: Array) -> float:
    model, feet, legs = walk.model, walk.feet, walk.model.legs
    return largest_excursion(velocity, feet.place[:legs], feet.stance[:legs], model.radius, walk.space.moved, time_left)


@kernel
def limit_velocity(walk: Record) -> float:
    """Shorten the ordered velocity (vx, vy, turn) to what the legs can do; returns the factor applied."""
    legs, gait, settings = walk.model.legs, walk.gait, walk.settings
    wanted, result = walk.orders.velocity, gait.limited
    size = speed_of(wanted)
    scale = 1.0 if size <= gait.fastest else gait.fastest / size
    for k in range(3):
        result[k] = scale * wanted[k]
    further = velocity_scale(
        result,
        walk.feet.stance[:legs],
        walk.model.radius,
        walk.space.moved,
        gait.duty,
        gait.frequency,
        settings.largest_stride,
    )
    for k in range(3):
        result[k] *= further
    return scale * further


@kernel
def approach(current: Array, target: Array, speed_up: float, slow_down: float, dt: float) -> None:
    """Move `current` (3,) towards `target` in place, by at most `speed_up` or, when slowing, `slow_down` m/s^2."""
    dx, dy, dw = target[0] - current[0], target[1] - current[1], TURN_RADIUS * (target[2] - current[2])
    gap = np.sqrt(dx * dx + dy * dy + dw * dw)
    step = (slow_down if speed_of(target) < speed_of(current) else speed_up) * dt
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
