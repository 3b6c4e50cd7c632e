"""The gait's clock, its start and stop, and who lifts."""

import numpy as np

from numpy_tick.orders import approached
from numpy_tick.servo_pace import forget_demand, pace_for
from numpy_tick.stride import stride_of
from robot_agent.locomotion import reasons
from robot_agent.locomotion.gait_clock import GLIDE, GLIDE_BEGINS
from robot_agent.locomotion.ground_search import DOWN
from robot_agent.locomotion.stepper import BRAKING_STRIDE, LEANT, PACE_TIME, SLOWNESS_TOLD, STOP_SLEW
from robot_agent.locomotion.trip import CLEAR

STAND, SWING, REACH, HANG = range(4)


def start_or_stop(walk):
    gait, mode = walk.gait, walk.feet.mode
    moving = walk.orders.velocity.any()
    if moving and not gait.walking:
        begin(walk)
    elif gait.walking:
        gait.halted = not moving or gait.skipped
        if gait.halted and not np.isin(mode, (SWING, REACH)).any() and not gait.commanded.any():
            gait.walking = gait.skipped = False
    if gait.walking and gait.halted and gait.skipped:
        gait.commanded = approached(walk, np.zeros(3), STOP_SLEW)


def begin(walk):
    gait, orders = walk.gait, walk.orders
    candidates = (1.0 - orders.offset) % 1.0
    costs = [cost_of_start(walk, phase) for phase in candidates]
    best = 0
    for candidate, cost in enumerate(costs):
        if cost < costs[best] - 1e-12:
            best = candidate
    start = gait.phase if walk.posing.fade > 0.0 else candidates[best]
    gait.phase, gait.duty, gait.offset, gait.gliding = start % 1.0, orders.duty, orders.offset, 0.0
    gait.leg_phase = (gait.phase + gait.offset) % 1.0
    at_lift_off = (gait.leg_phase < 1e-9) | (gait.leg_phase > 1.0 - 1e-9)
    walk.feet.lifted = (gait.leg_phase < 1.0 - gait.duty) & ~at_lift_off
    gait.walking, gait.skipped, gait.halted, gait.waited = True, False, False, 0.0
    gait.pace = 0.0 if walk.posing.always else 1.0
    forget_demand(walk)


def cost_of_start(walk, phase):
    """Square of how far, m, the worst foot strays from its stance before its first swing."""
    worst = 0.0
    for leg, stance in enumerate(walk.feet.stance):
        own = (phase + walk.orders.offset[leg]) % 1.0
        left = 0.0 if min(own, 1.0 - own) < 1e-9 else 1.0 - own
        stride = stride_of(walk.orders.velocity, stance, walk.orders.duty, walk.gait.frequency)
        away = (walk.feet.place[leg] - stance - stride * left / walk.orders.duty)[:2]
        worst = max(worst, away @ away)
    return worst


def advance(walk):
    gait, feet, dt = walk.gait, walk.feet, walk.model.dt
    on_ground = np.isin(feet.mode, (STAND, HANG))
    due = (on_ground & (feet.lifted == 0)) | (gait.leg_phase >= 1.0 - gait.duty)
    until_lift = min([1.0, *(1.0 - gait.leg_phase[due])])
    reaching = (feet.mode == REACH).any()
    follow_pace(walk, np.clip(until_lift / BRAKING_STRIDE, 0.0, 1.0) if reaching else float(leans(walk)))
    strides = gait.frequency * dt * gait.pace
    if reaching and strides >= until_lift - 1e-4:
        searching = ((feet.mode == REACH) & (feet.tried > 0)).any()
        strides, gait.waited = 0.0, gait.waited + (0.0 if searching else dt)
        walk.answer.reasons |= reasons.NO_GROUND
        if gait.waited > walk.settings.foothold.waiting_time:
            feet.mode = np.where(feet.mode == REACH, HANG, feet.mode)
    else:
        gait.waited = 0.0
    run_clock(walk, strides)
    if leans(walk):
        lift_feet(walk)


def leans(walk):
    """Whether a foot may lift: the body leans as the gait needs, or has already begun without."""
    posing = walk.posing
    return not posing.always or posing.fade >= LEANT or np.isin(walk.feet.mode, (SWING, REACH)).any()


def follow_pace(walk, target):
    gait, change = walk.gait, walk.model.dt / PACE_TIME
    spared = walk.settings.spare_servos and not gait.halted
    if spared:
        target = min(target, gait.stride_pace)
        if gait.stride_pace < 1.0 - SLOWNESS_TOLD:
            walk.answer.reasons |= reasons.SLOW_SERVOS
    gait.pace += np.clip(target - gait.pace, -change, change)
    if spared:
        gait.pace = min(gait.pace, pace_for(gait.demand))


def run_clock(walk, strides):
    gait, orders = walk.gait, walk.orders
    gap = (orders.offset - gait.offset + 0.5) % 1.0 - 0.5
    changes = max(np.abs(gap).max(), abs(orders.duty - gait.duty)) > 1e-9
    gait.gliding = min(gait.gliding + strides / GLIDE_BEGINS, 1.0) if changes else 0.0
    step = gait.gliding * GLIDE * strides
    gait.phase = (gait.phase + strides) % 1.0
    gait.offset = (gait.offset + np.clip(gap, -step, step)) % 1.0
    gait.leg_phase = (gait.phase + gait.offset) % 1.0
    gait.duty += np.clip(orders.duty - gait.duty, -step, step)


def lift_feet(walk):
    gait, feet, load = walk.gait, walk.feet, walk.load
    for leg in range(walk.model.legs):
        if gait.leg_phase[leg] >= 1.0 - gait.duty:
            feet.lifted[leg] = False
        elif not feet.lifted[leg] and feet.mode[leg] in (STAND, HANG):
            if gait.halted:
                gait.skipped = True
                continue
            feet.place[leg] += load.offset[leg, 0] * walk.senses.unposed_up
            feet.lift_off[leg] = feet.place[leg]
            load.offset[leg] = 0.0
            feet.mode[leg], feet.lifted[leg] = SWING, True
            feet.swing_height[leg], feet.reached[leg] = min(gait.height, walk.model.headroom[leg]), 0.0
            feet.seeking[leg], feet.tried[leg] = DOWN, 0
            feet.tripped[leg], feet.detour[leg] = CLEAR, 0.0
            feet.planned[leg], feet.aimed[leg] = False, walk.orders.targeted[leg]
