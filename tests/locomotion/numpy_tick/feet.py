"""Feet on the ground and in the air."""

import numpy as np

from numpy_tick.stride import bezier, ground_velocity, stride_of, swing_nodes
from numpy_tick.walkspace import room
from robot_agent.locomotion import reasons
from robot_agent.locomotion.feet import FOOTHOLD_SPEED
from robot_agent.locomotion.ground_search import ACROSS, CLEARANCE, DOWN, PLACES, SHARE, SPEED, UP
from robot_agent.locomotion.trip import BACK_SPEED, FREED, STRUCK
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
        if swinging and feels:
            notice_trip(walk, leg, progress)
        early = progress <= walk.settings.foothold.earliest_contact or feet.tripped[leg] == STRUCK
        early = early and swinging
        if not swinging and feet.seeking[leg] != DOWN:
            seek(walk, leg)
        elif touches and not early:
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
    foothold = aimed_foothold(walk, leg) if feet.aimed[leg] else drawn_foothold(walk, leg, foothold)
    half_time = 0.5 * (1.0 - gait.duty) / gait.frequency
    if progress >= 1.0:
        feet.place[leg] = foothold + ground * (progress - 1.0) * 2.0 * half_time
        feet.mode[leg] = STAND
        return
    speed = walk.settings.foothold.touchdown_speed if walk.settings.feel_ground else 0.0
    settings = walk.settings.foothold
    outward = np.array([0.0, settings.swing_width * (1.0 if stance[1] > 0.0 else -1.0), 0.0])
    first, second = swing_nodes(
        feet.lift_off[leg],
        foothold,
        direction_of_swing(walk),
        feet.swing_height[leg],
        ground,
        speed,
        half_time,
        settings.along_normal,
        outward,
    )
    path = bezier(first, 2.0 * progress) if progress < 0.5 else bezier(second, 2.0 * progress - 1.0)
    if feet.tripped[leg]:
        lead_around(walk, leg, path, foothold)
    else:
        feet.place[leg] = path


def notice_trip(walk, leg, progress):
    feet, settings, touches = walk.feet, walk.settings.foothold, walk.senses.contact[leg] != 0
    if feet.tripped[leg] == STRUCK and (not touches or progress >= settings.trip_to):
        feet.tripped[leg] = FREED
    elif feet.tripped[leg] != STRUCK and touches and settings.trip_from < progress <= settings.earliest_contact:
        feet.tripped[leg] = STRUCK


def lead_around(walk, leg, path, foothold):
    """Back from what was struck and up along it, or back to the path."""
    feet, settings, dt = walk.feet, walk.settings.foothold, walk.model.dt
    if feet.tripped[leg] == STRUCK:
        place = feet.place[leg].copy()
        onwards = (foothold - feet.lift_off[leg])[:2]
        onwards = onwards / max(np.linalg.norm(onwards), 1e-9)
        away = walk.senses.unposed_feet[leg][:2] - settings.trip_retreat * onwards - place[:2]
        place[:2] += away * min(1.0, BACK_SPEED * dt / max(np.linalg.norm(away), 1e-9))
        highest = max(feet.stance[leg][2] + walk.model.headroom[leg], place[2])
        place[2] = min(place[2] + settings.trip_rise * dt, highest)
        feet.detour[leg] = place - path
    else:
        flat, lower = feet.detour[leg][:2], settings.touchdown_speed * dt
        far = np.linalg.norm(flat)
        flat = flat * (1.0 - min(1.0, BACK_SPEED * dt / max(far, 1e-9)))
        height = feet.detour[leg][2]
        feet.detour[leg] = [*flat, height - np.clip(height, -lower, lower)]
    feet.place[leg] = path + feet.detour[leg]


def drawn_foothold(walk, leg, foothold):
    """The plan, or as far towards it as a tick's way goes."""
    feet, largest = walk.feet, FOOTHOLD_SPEED * walk.model.dt
    if feet.planned[leg]:
        change = foothold - feet.foothold[leg]
        away = np.linalg.norm(change)
        foothold = feet.foothold[leg] + change * (min(1.0, largest / away) if away > 0.0 else 1.0)
    feet.planned[leg], feet.foothold[leg] = True, foothold
    return foothold


def aimed_foothold(walk, leg):
    """The ordered place, or the nearest to it in the walkspace."""
    stance, target, model = walk.feet.stance[leg], walk.orders.target[leg], walk.model
    away = (target - stance)[:2]
    far, free = np.linalg.norm(away), room(walk, leg, *away)
    if far > free:
        walk.answer.reasons |= reasons.FOOTHOLD
        away = away * free / far
    return np.array([*(stance[:2] + away), np.clip(target[2], model.down_limit, model.up_limit)])


def direction_of_swing(walk):
    """Against gravity, or off the ground."""
    if not walk.settings.foothold.along_normal:
        return walk.senses.unposed_up
    normal = np.array([-walk.body.plane[0], -walk.body.plane[1], 1.0])
    return normal / np.linalg.norm(normal)


def reach(walk, leg):
    feet, settings, dt = walk.feet, walk.settings.foothold, walk.model.dt
    ground = ground_velocity(walk.gait.commanded, feet.stance[leg])
    feet.place[leg] += (walk.gait.pace * ground - settings.touchdown_speed * direction_of_swing(walk)) * dt
    feet.reached[leg] += settings.touchdown_speed * dt
    too_far = feet.reached[leg] > settings.reach_down or feet.place[leg, 2] < walk.model.down_limit
    feet.mode[leg] = REACH
    if too_far and (walk.gait.halted or feet.tried[leg] == PLACES):
        feet.mode[leg] = HANG
    elif too_far:
        feet.goal[leg] = place_to_try(walk, leg, feet.tried[leg])
        feet.tried[leg], feet.seeking[leg] = feet.tried[leg] + 1, UP


def place_to_try(walk, leg, number):
    """Inwards, the middle, ahead, where the foot stood last, outwards."""
    stance, lift_off = walk.feet.stance[leg][:2], walk.feet.lift_off[leg][:2]
    inwards = np.array([0.0, -np.sign(stance[1])])
    ahead = -ground_velocity(walk.gait.limited, walk.feet.stance[leg])[:2]
    way = (inwards, np.zeros(2), ahead, lift_off - stance, -inwards)[number]
    far = np.linalg.norm(way)
    if far <= 1e-9:
        return stance
    length = SHARE * room(walk, leg, *way)
    return stance + way / far * (min(length, far) if number == 3 else length)


def seek(walk, leg):
    """Up, across, and along what is in the way."""
    feet, step, plane = walk.feet, SPEED * walk.model.dt, walk.body.plane
    place, goal, touches = feet.place[leg], feet.goal[leg], walk.senses.contact[leg] != 0
    expected = plane @ [*goal, 1.0]
    highest = max(feet.stance[leg][2] + walk.model.headroom[leg], place[2])
    way = goal - place[:2]
    far = np.linalg.norm(way)
    if walk.gait.halted:
        feet.seeking[leg] = DOWN
    elif feet.seeking[leg] == UP:
        top = min(max(feet.lift_off[leg][2], expected) + CLEARANCE, highest)
        place[2] = max(place[2], min(place[2] + step, top))
        feet.seeking[leg] = ACROSS if place[2] >= top else UP
    elif touches and place[2] < highest:
        place[2] = min(place[2] + step, highest)
    else:
        place[:2] += way * min(1.0, step / max(far, 1e-9))
        feet.seeking[leg] = DOWN if far <= step or touches else ACROSS
    if feet.seeking[leg] == DOWN:
        feet.reached[leg] = expected - place[2]


def take_anchors(walk):
    feet, senses, feels = walk.feet, walk.senses, walk.settings.feel_ground
    known = (feet.mode == STAND) & ((senses.contact != 0) | (not feels))
    feet.anchor = np.where(known[:, None], senses.unposed_feet if feels else feet.place, feet.anchor)
