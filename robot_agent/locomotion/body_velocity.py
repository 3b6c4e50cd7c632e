"""The velocity really walked: within every leg's stride, within the largest speed, and without jumps."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.body_speed import TURN_RADIUS, speed_of
from robot_agent.locomotion.excursion import largest_excursion, ways_left
from robot_agent.locomotion.reasons import STRIDE, VELOCITY
from robot_agent.locomotion.walk_state import Array, Record
from robot_agent.locomotion.walkspace import velocity_scale

STILL = 1e-4
"""m/s or rad/s under which a command means stop."""
HALVINGS = 5
"""Of a tick's change of velocity."""
SPARE = 1e-6
"""Of a walkspace, by which rounding may leave it."""


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
    """Change the commanded velocity to `wanted` (3,) as far as every foot stays in its walkspace until it lifts next.

    Feet that were put down for another velocity may have less way left. A robot may always brake, so what is taken is
    a share of the change from braking to the wanted velocity; no foot leaves its walkspace farther than braking can
    help.
    """
    commanded, legs = walk.gait.commanded, walk.model.legs
    if walk.gait.walking:
        ways = np.empty((legs, 4))
        ways_left(walk, ways)
        if largest_excursion(walk, wanted, ways) > 1.0 + SPARE:
            slow_down = walk.settings.largest_speed / walk.settings.stop_time
            approach(commanded, np.zeros(3), 0.0, slow_down, walk.model.dt)
            share = _affordable(walk, wanted, ways)
            for k in range(3):
                commanded[k] += share * (wanted[k] - commanded[k])
            return
    commanded[:] = wanted


@kernel
def _affordable(walk: Record, wanted: Array, ways: Array) -> float:
    """The share 0..1 of the change from the commanded velocity to `wanted` that the feet's ways allow, by halving."""
    braked, trial = walk.gait.commanded, np.empty(3)
    share, step = 1.0, 1.0
    allowed = max(1.0, largest_excursion(walk, braked, ways)) + SPARE
    for _ in range(HALVINGS):
        for k in range(3):
            trial[k] = braked[k] + share * (wanted[k] - braked[k])
        step *= 0.5
        if largest_excursion(walk, trial, ways) > allowed:
            share -= step
        elif share == 1.0:
            return 1.0
        else:
            share += step
    return max(share - step, 0.0)


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
