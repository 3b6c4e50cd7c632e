"""The body's pose: slews by their definition, levelling, and the gait's own pose."""

import numpy as np

from robot_agent.locomotion.posing.automatic import bump
from robot_agent.locomotion.posing.pose_tick import FADE, LEVEL, LIMITED, MANUAL, MEANS, VALUE
from weaver_shared.transforms import Pose, rotation_from_rpy


def pose_body(walk, slews):
    posing, gait = walk.posing, walk.gait
    manual = pose_of(slew(walk, slews, MANUAL, posing.manual))
    on = 1.0 if posing.automatic and gait.walking else 0.0
    fade = posing.fade = slew(walk, slews, FADE, np.array([on, 0.0, 0.0, 0.0, 0.0, 0.0]))[0]
    longer = 1.0 - gait.duty + 2.0 * posing.ahead
    height = bump((gait.leg_phase + posing.ahead) % 1.0 / longer) @ posing.amplitude
    calm = np.minimum(1.0, posing.rates / np.maximum(posing.slope * gait.frequency, 1e-12))
    unlevelled = manual @ pose_of(fade * calm * height)
    roll, pitch = level(walk, unlevelled.rotation @ walk.senses.up)
    levelling = pose_of(slew(walk, slews, LEVEL, np.array([0.0, 0.0, 0.0, roll, pitch, 0.0])))
    posing.idle = not posing.wanted and (walk.posing.still > slews.shape[1] - MEANS).all()
    pose, still = (Pose.identity(),) * 2 if posing.idle else (levelling @ unlevelled, levelling @ manual)
    walk.orders.posing_rotation, walk.orders.posing_position = pose.rotation, pose.position
    walk.orders.still_rotation, walk.orders.still_position = still.rotation, still.position


def pose_of(values):
    return Pose(rotation=rotation_from_rpy(*values[3:]), position=values[:3].copy())


def slew(walk, slews, which, wanted):
    """A rate limit and two running means."""
    posing, own = walk.posing, slews[which]
    if posing.still[which] > len(own) - MEANS and (wanted == own[LIMITED]).all():
        return own[VALUE]
    gap = wanted - own[LIMITED]
    far = max(np.linalg.norm(gap[:3]) / posing.steps[which][0], np.linalg.norm(gap[3:]) / posing.steps[which][1])
    own[LIMITED] = wanted if far <= 1.0 else own[LIMITED] + gap / far
    first, second = own[MEANS : MEANS + posing.first], own[MEANS + posing.first :]
    tick = posing.ticks[which]
    first[tick % len(first)] = own[LIMITED]
    second[tick % len(second)] = first.mean(axis=0)
    own[VALUE] = second.mean(axis=0)
    posing.still[which] = 0 if far > 0.0 else posing.still[which] + 1
    posing.ticks[which] += 1
    return own[VALUE]


def level(walk, up):
    posing, dt = walk.posing, walk.model.dt
    if not posing.levelling:
        posing.measured, posing.integral, posing.tilt_rate, posing.turn = 0, 0.0, 0.0, 0.0
        return 0.0, 0.0
    sine = np.hypot(up[0], up[1])
    error = np.array([-up[1], up[0]]) * (np.arctan2(sine, up[2]) / sine if sine > 1e-12 else 0.0)
    proportional, integral, derivative = posing.gains
    if posing.measured:
        posing.tilt_rate += posing.rate_blend * ((error - posing.tilt) / dt - posing.tilt_rate)
    posing.tilt, posing.measured = error, 1
    free = proportional * error + posing.integral + derivative * posing.tilt_rate
    grown = posing.integral + integral * error * dt
    pushed = (np.abs(free) >= posing.largest) & (np.abs(grown) > np.abs(posing.integral))
    posing.turn = np.clip(free, -posing.largest, posing.largest)
    posing.integral = np.clip(np.where(pushed, posing.integral, grown), -posing.largest, posing.largest)
    return posing.turn
