"""Orders made finite, bounded and slow: velocity and gait parameters."""

import numpy as np

from robot_agent.locomotion import reasons
from robot_agent.locomotion.body_velocity import STILL, TURN_RADIUS
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


def speed_of(velocity):
    """m/s: turning counts like a foot's speed."""
    return np.linalg.norm(velocity * [1.0, 1.0, TURN_RADIUS])


def follow_velocity(walk):
    gait, settings = walk.gait, walk.settings
    speed = speed_of(walk.orders.velocity)
    share = min(1.0, settings.largest_speed / speed) if speed > 0.0 else 1.0
    share *= stride_share(walk, share * walk.orders.velocity)
    if share < 0.999:
        walk.answer.reasons |= reasons.STRIDE
    gait.limited = share * walk.orders.velocity
    approach(walk, gait.limited, settings.largest_speed / settings.start_time)


def approach(walk, target, speed_up):
    gait, settings = walk.gait, walk.settings
    rate = settings.largest_speed / settings.stop_time if speed_of(target) < speed_of(gait.commanded) else speed_up
    gap = speed_of(target - gait.commanded)
    gait.commanded += min(1.0, rate * walk.model.dt / gap if gap > 0.0 else 1.0) * (target - gait.commanded)


def stride_share(walk, velocity):
    """The factor, at most 1, that keeps every leg's stride within its radius."""
    gait, share = walk.gait, 1.0
    for leg, (x, y, _) in enumerate(walk.feet.stance):
        along = velocity[:2] + velocity[2] * np.array([-y, x])
        half = 0.5 * np.linalg.norm(along) * gait.duty / gait.frequency
        if half > 0.0:
            bearings = walk.model.radius.shape[1]
            place = np.arctan2(along[1], along[0]) % (2.0 * np.pi) / (2.0 * np.pi) * bearings
            radius = np.interp(
                place, np.arange(bearings + 1), np.append(walk.model.radius[leg], walk.model.radius[leg, 0])
            )
            share = min(share, min(radius, 0.5 * walk.settings.largest_stride) / half)
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
