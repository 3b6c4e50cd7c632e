"""Feet on the ground and in the air."""

import numpy as np

from numpy_tick.stride import bezier, ground_velocity, stride_of, swing_nodes
from weaver_shared.transforms import rotation_exp

STAND, SWING, REACH, HANG = range(4)


def carry_feet(walk):
    feet, body, dt = walk.feet, walk.body, walk.model.dt
    on_ground = np.isin(feet.mode, (STAND, HANG))[:, None]
    feet.place = np.where(on_ground, carried(feet.place, body.whole_linear, body.whole_angular, dt), feet.place)
    feet.anchor = carried(feet.anchor, body.whole_linear, body.whole_angular, dt)
    feet.lift_off = carried(feet.lift_off, body.linear, body.angular, dt)


def carried(points, linear, angular, dt):
    """Points (n, 3) of the ground after a tick, seen from a body with this twist."""
    return (points - linear * dt) @ rotation_exp(-angular * dt).T


def move_swinging(walk):
    feet, gait, feels = walk.feet, walk.gait, walk.settings.feel_ground
    for leg in range(walk.model.legs):
        if feet.mode[leg] not in (SWING, REACH):
            continue
        progress = gait.leg_phase[leg] / (1.0 - gait.duty)
        touches, swinging = feels and walk.senses.contact[leg], feet.mode[leg] == SWING
        early = swinging and progress <= walk.settings.foothold.earliest_contact
        if touches and not early:
            feet.mode[leg] = STAND
        elif swinging and (progress < 1.0 or not feels):
            swing(walk, leg, progress)
        elif touches:
            feet.mode[leg] = STAND
        else:
            reach(walk, leg)


def swing(walk, leg, progress):
    feet, gait, model = walk.feet, walk.gait, walk.model
    stance, plane = feet.stance[leg], walk.body.plane
    ground = ground_velocity(gait.commanded, stance)
    foothold = stance + 0.5 * stride_of(gait.commanded, stance, gait.duty, gait.frequency)
    foothold[2] = np.clip(plane @ [foothold[0], foothold[1], 1.0], model.down_limit, model.up_limit)
    half_time = 0.5 * (1.0 - gait.duty) / gait.frequency
    if progress >= 1.0:
        feet.place[leg] = foothold + ground * (progress - 1.0) * 2.0 * half_time
        feet.mode[leg] = STAND
        return
    speed = walk.settings.foothold.touchdown_speed if walk.settings.feel_ground else 0.0
    first, second = swing_nodes(
        feet.lift_off[leg], foothold, walk.senses.unposed_up, feet.swing_height[leg], ground, speed, half_time
    )
    feet.place[leg] = bezier(first, 2.0 * progress) if progress < 0.5 else bezier(second, 2.0 * progress - 1.0)


def reach(walk, leg):
    feet, settings, dt = walk.feet, walk.settings.foothold, walk.model.dt
    ground = ground_velocity(walk.gait.commanded, feet.stance[leg])
    feet.place[leg] += (walk.gait.pace * ground - settings.touchdown_speed * walk.senses.unposed_up) * dt
    feet.reached[leg] += settings.touchdown_speed * dt
    too_far = feet.reached[leg] > settings.reach_down or feet.place[leg, 2] < walk.model.down_limit
    feet.mode[leg] = HANG if too_far else REACH


def take_anchors(walk):
    feet, senses, feels = walk.feet, walk.senses, walk.settings.feel_ground
    known = (feet.mode == STAND) & ((senses.contact != 0) | (not feels))
    feet.anchor = np.where(known[:, None], senses.unposed_feet if feels else feet.place, feet.anchor)
