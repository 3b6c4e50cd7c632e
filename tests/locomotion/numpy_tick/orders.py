"""Orders made finite, bounded and slow: velocity and gait parameters."""

import numpy as np

from numpy_tick.speed import speed_of
from numpy_tick.walkspace import excursion, room, ways_left
from robot_agent.locomotion import reasons
from robot_agent.locomotion.body_velocity import HALVINGS, SPARE, STILL
from robot_agent.locomotion.stepper import FREE_OVERRUN, LARGEST_OVERRUN

SWING = 1


def clean_velocity(walk):
    velocity = walk.orders.velocity
    if not np.isfinite(velocity).all():
        walk.answer.reasons |= reasons.VELOCITY
        walk.orders.velocity = 0.0
    elif np.abs(velocity).max() <= STILL:
        walk.orders.velocity = 0.0


def follow_parameters(walk):
    gait, settings, orders = walk.gait, walk.settings, walk.orders
    usable = np.isfinite(orders.parameters)
    names = ("frequency", "height", "stiffness")
    bounds = (settings.frequency_bounds, settings.height_bounds, settings.admittance.stiffness_bounds)
    rates = (settings.frequency_rate, settings.height_rate, settings.stiffness_rate)
    if not usable.all():
        walk.answer.reasons |= reasons.PARAMETER
    for k, name in enumerate(names):
        wanted = np.clip(orders.parameters[k], *bounds[k]) if usable[k] else getattr(gait, name)
        if name == "frequency":
            wanted = min(wanted, (1.0 - orders.duty) / settings.shortest_swing)
        change = wanted - getattr(gait, name)
        if gait.started:
            change = np.clip(change, -rates[k] * walk.model.dt, rates[k] * walk.model.dt)
        setattr(gait, name, getattr(gait, name) + change)
    gait.started = gait.started or usable.all()


def follow_velocity(walk):
    gait, settings = walk.gait, walk.settings
    speed = speed_of(walk.orders.velocity)
    share = min(1.0, gait.fastest / speed) if speed > 0.0 else 1.0
    share *= stride_share(walk, share * walk.orders.velocity)
    if share < 0.999:
        walk.answer.reasons |= reasons.STRIDE
    gait.limited = share * walk.orders.velocity
    wanted = approached(walk, gait.limited, settings.largest_speed / settings.start_time)
    gait.commanded = fitting(walk, wanted)


def approached(walk, target, speed_up):
    """The commanded velocity a tick nearer to `target`."""
    gait, settings = walk.gait, walk.settings
    rate = settings.largest_speed / settings.stop_time if speed_of(target) < speed_of(gait.commanded) else speed_up
    gap = speed_of(target - gait.commanded)
    return gait.commanded + min(1.0, rate * walk.model.dt / gap if gap > 0.0 else 1.0) * (target - gait.commanded)


def fitting(walk, wanted):
    """As much of a change from braking to `wanted` as leaves every foot room until it lifts next."""
    gait, ways = walk.gait, ways_left(walk)
    if not gait.walking or excursion(walk, wanted, ways) <= 1.0 + SPARE:
        return wanted
    braked = approached(walk, np.zeros(3), 0.0)
    allowed = max(1.0, excursion(walk, braked, ways)) + SPARE

    def fits(share):
        return excursion(walk, braked + share * (wanted - braked), ways) <= allowed

    if fits(1.0):
        return wanted
    least, most = 0.0, 1.0
    for _ in range(HALVINGS - 1):
        middle = 0.5 * (least + most)
        least, most = (middle, most) if fits(middle) else (least, middle)
    return braked + least * (wanted - braked)


def stride_share(walk, velocity):
    """The factor, at most 1, that keeps every leg's stride within its walkspace."""
    gait, share = walk.gait, 1.0
    for leg, (x, y, _) in enumerate(walk.feet.stance):
        along = velocity[:2] + velocity[2] * np.array([-y, x])
        half = 0.5 * np.linalg.norm(along) * gait.duty / gait.frequency
        if half > 0.0:
            share = min(share, min(room(walk, leg, *along), 0.5 * walk.settings.largest_stride) / half)
    return share


def walked_velocity(walk):
    """The commanded velocity at the gait's pace, less where a foot has been left behind."""
    gait = walk.gait
    gait.velocity = gait.commanded * gait.pace
    worst = 0.0
    for leg in range(walk.model.legs):
        away = (walk.feet.place[leg] - walk.feet.stance[leg])[:2]
        x, y, _ = walk.feet.stance[leg]
        along = -gait.velocity[:2] + gait.velocity[2] * np.array([y, -x])
        if walk.feet.mode[leg] != SWING and away @ along > 0.0:
            worst = max(worst, np.linalg.norm(away) / (0.5 * walk.settings.largest_stride))
    if worst > FREE_OVERRUN:
        walk.answer.reasons |= reasons.LEFT_BEHIND
        gait.velocity *= max((LARGEST_OVERRUN - worst) / (LARGEST_OVERRUN - FREE_OVERRUN), 0.0)
