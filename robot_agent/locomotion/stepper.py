"""Feet and body while standing and walking: gait, footholds, posture, load and impedance, in that order."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.body_motion import move_body
from robot_agent.locomotion.body_velocity import approach, follow_velocity
from robot_agent.locomotion.feet import (
    HANG,
    REACH,
    STAND,
    SWING,
    carry_feet,
    count_mode,
    lift,
    move_swinging,
    stand_at,
    take_anchors,
    until_next_lift,
)
from robot_agent.locomotion.gait_clock import advance_clock, restart_clock
from robot_agent.locomotion.gait_start import best_start, overrun
from robot_agent.locomotion.impedance import give_way
from robot_agent.locomotion.load import carry_load
from robot_agent.locomotion.reasons import LEFT_BEHIND, NO_GROUND, SLOW_SERVOS
from robot_agent.locomotion.servo_pace import forget_demand, pace_of_moment
from robot_agent.locomotion.walk_state import Array, Record
from robot_agent.locomotion.walkspace_renewal import renew_walkspace

PACE_TIME = 0.12
"""s in which the gait slows to a halt when a foot finds no ground, and takes up again."""
BRAKING_STRIDE = 0.05
"""Fraction of a stride before the next lift-off at which a waiting gait begins to slow."""
FREE_OVERRUN, LARGEST_OVERRUN = 1.2, 1.5
"""In half strides: where a foot left too far behind begins to slow the body, and where it stops it."""
SLOWNESS_TOLD = 0.02
"""Of the pace, lost to slow servos, from where on it is said."""
LEANT = 0.95
"""Of the automatic pose, with which a gait that needs it begins."""
STOP_SLEW = 1.0
"""m/s^2 towards an end of the walk that a missed lift-off makes necessary."""


@kernel
def stand(memory: Array, places: Array, share: float) -> None:
    """Stand with the feet at `places` (legs, 3), each carrying its `share` 0..1."""
    walk = memory[0]
    body, up, legs = walk.body, walk.senses.unposed_up, walk.model.legs
    stand_at(walk, places)
    height = 0.0
    for leg in range(legs):
        walk.load.offset[leg, :] = 0.0
        walk.load.share[leg] = share
        height += places[leg, 2] / legs
    body.plane[0], body.plane[1], body.plane[2] = -up[0] / up[2], -up[1] / up[2], height
    body.shift[:] = 0.0
    walk.gait.walking = False
    walk.gait.pace = 1.0
    walk.gait.commanded[:] = 0.0
    walk.gait.velocity[:] = 0.0


@kernel
def step(walk: Record) -> None:
    """One tick towards the ordered velocity: where the feet belong, and what they carry."""
    shift_stance(walk)
    renew_walkspace(walk)
    follow_velocity(walk)
    start_or_stop(walk)
    if walk.gait.walking:
        advance(walk)
    move(walk)
    carry_load(walk)
    if walk.settings.feel_ground:
        give_way(walk)


@kernel
def shift_stance(walk: Record) -> None:
    """Middle of every foot's stance, shifted for the inclination."""
    stance, nominal, shift = walk.feet.stance, walk.model.stance, walk.body.shift
    for leg in range(walk.model.legs):
        stance[leg, 0] = nominal[leg, 0] + shift[0]
        stance[leg, 1] = nominal[leg, 1] + shift[1]
        stance[leg, 2] = nominal[leg, 2]


@kernel
def start_or_stop(walk: Record) -> None:
    """Begin to walk when a velocity is ordered, and end when the body stands and every foot is down."""
    gait = walk.gait
    moving = walk.orders.velocity.any()
    if moving and not gait.walking:
        begin_to_walk(walk)
    elif gait.walking:
        gait.halted = not moving or gait.skipped
        in_air = count_mode(walk, SWING) + count_mode(walk, REACH) > 0
        if gait.halted and not in_air and not gait.commanded.any():
            gait.walking = False
            gait.skipped = False
    if gait.walking and gait.halted and gait.skipped:
        slow_down = walk.settings.largest_speed / walk.settings.stop_time
        approach(gait.commanded, np.zeros(3), STOP_SLEW, slow_down, walk.model.dt)


@kernel
def begin_to_walk(walk: Record) -> None:
    """Start the clock where the feet's places suit it; a leg whose swing has already begun waits for its next.

    A body that still leans as it did at the last stop goes on from there, for its pose follows the clock.
    """
    gait, feet = walk.gait, walk.feet
    restart_clock(walk, gait.phase if walk.posing.fade > 0.0 else best_start(walk))
    for leg in range(walk.model.legs):
        phase = gait.leg_phase[leg]
        at_lift_off = phase < 1e-9 or phase > 1.0 - 1e-9
        feet.lifted[leg] = phase < 1.0 - gait.duty and not at_lift_off
    gait.walking, gait.skipped, gait.halted = True, False, False
    gait.pace, gait.waited = 0.0 if walk.posing.always else 1.0, 0.0
    forget_demand(walk)


@kernel
def advance(walk: Record) -> None:
    """Run the clock and lift the feet whose swing begins, or hold it while a foot still reaches for the ground."""
    gait, dt = walk.gait, walk.model.dt
    until_lift = until_next_lift(walk)
    reaching = count_mode(walk, REACH) > 0
    target = 0.0 if must_lean_first(walk) else 1.0
    follow_pace(walk, min(max(until_lift / BRAKING_STRIDE, 0.0), 1.0) if reaching else target)
    strides = gait.frequency * dt * gait.pace
    if reaching and strides >= until_lift - 1e-4:
        strides = 0.0
        gait.waited += 0.0 if searching(walk) else dt
        walk.answer.reasons |= NO_GROUND
        if gait.waited > walk.settings.foothold.waiting_time:
            give_up_reaching(walk)
    else:
        gait.waited = 0.0
    advance_clock(walk, strides)
    if not must_lean_first(walk):
        lift_feet(walk)


@kernel
def must_lean_first(walk: Record) -> bool:
    """Whether no foot may lift yet, because the body does not lean away from it as this gait needs."""
    if not walk.posing.always or walk.posing.fade >= LEANT:
        return False
    return count_mode(walk, SWING) + count_mode(walk, REACH) == 0


@kernel
def follow_pace(walk: Record, target: float) -> None:
    """Bring the pace nearer to its target, but not beyond what the servos can follow, unless the feet are to land."""
    gait, change = walk.gait, walk.model.dt / PACE_TIME
    if gait.halted or not walk.settings.spare_servos:
        gait.pace += min(max(target - gait.pace, -change), change)
        return
    most = gait.stride_pace
    if most < 1.0 - SLOWNESS_TOLD:
        walk.answer.reasons |= SLOW_SERVOS
    gait.pace += min(max(min(target, most) - gait.pace, -change), change)
    gait.pace = min(gait.pace, pace_of_moment(walk))


@kernel
def searching(walk: Record) -> bool:
    """Whether a foot looks for ground elsewhere: that ends by itself."""
    count = 0
    for leg in range(walk.model.legs):
        count += walk.feet.mode[leg] == REACH and walk.feet.tried[leg] > 0
    return count > 0


@kernel
def give_up_reaching(walk: Record) -> None:
    for leg in range(walk.model.legs):
        if walk.feet.mode[leg] == REACH:
            walk.feet.mode[leg] = HANG


@kernel
def lift_feet(walk: Record) -> None:
    """Lift what is due; a walk that ends lifts no more, and remembers that it has not."""
    gait, feet = walk.gait, walk.feet
    for leg in range(walk.model.legs):
        if gait.leg_phase[leg] >= 1.0 - gait.duty:
            feet.lifted[leg] = False
        elif not feet.lifted[leg] and (feet.mode[leg] == STAND or feet.mode[leg] == HANG):
            if gait.halted:
                gait.skipped = True
            else:
                lift(walk, leg)


@kernel
def move(walk: Record) -> None:
    """Move the body over the standing feet and the swinging feet over the ground."""
    gait = walk.gait
    for k in range(3):
        gait.velocity[k] = gait.commanded[k] * gait.pace
    far = overrun(walk)
    if far > FREE_OVERRUN:
        left = max((LARGEST_OVERRUN - far) / (LARGEST_OVERRUN - FREE_OVERRUN), 0.0)
        for k in range(3):
            gait.velocity[k] *= left
        walk.answer.reasons |= LEFT_BEHIND
    move_body(walk)
    carry_feet(walk)
    move_swinging(walk)
    take_anchors(walk)
