"""Room for every foot: walkspaces about stances that move, kept up a few places a tick."""

from types import SimpleNamespace

import numpy as np

from numpy_tick.inverse import solve_leg
from numpy_tick.stride import stride_of
from robot_agent.locomotion.feet import FOOTHOLD_SPEED, REACH, STAND, SWING
from robot_agent.locomotion.gait_clock import GLIDE
from robot_agent.locomotion.walk_state import BEARINGS, LAYERS
from robot_agent.locomotion.walkspace_renewal import STALE
from robot_agent.locomotion.workspace import (
    FIRST_ITERATIONS,
    HALVINGS,
    ITERATIONS,
    LARGEST_TURN,
    RADIUS_STEP,
    REACHED,
    USED,
)


def room(walk, leg, x, y):
    """m that a foot may be from its stance in the direction (x, y)."""
    radius = walk.model.radius[leg]
    place = np.arctan2(y, x) % (2.0 * np.pi) / (2.0 * np.pi) * radius.size
    towards = np.interp(place, np.arange(radius.size + 1), np.append(radius, radius[0]))
    return max(towards - walk.space.moved[leg], 0.0)


def ways_left(walk):
    """Of each leg: whence it will stand, how far that may still be moved (m; nan: no more), and for how long (s)."""
    gait, feet = walk.gait, walk.feet
    standing, swinging = np.isin(feet.mode, (STAND, REACH)), feet.mode == SWING
    until_lift = strides_until(walk, 1.0 - gait.leg_phase) / gait.frequency
    until_landing = strides_until(walk, np.maximum(1.0 - gait.duty - gait.leg_phase, 0.0)) / gait.frequency
    due = (gait.leg_phase < 1.0 - gait.duty) & (feet.lifted == 0)
    aims = swinging & (feet.planned == 1) & (feet.aimed == 0)
    begin = np.where(aims[:, None], feet.foothold, feet.place)
    slack = np.where(aims, FOOTHOLD_SPEED * until_landing, np.nan)
    time = np.where(standing & ~due, until_lift, np.where(aims, until_lift - until_landing, 0.0))
    return list(zip(begin, slack, time, strict=True))


def strides_until(walk, phase_left):
    """Strides until the legs have gone on by `phase_left` (legs,), while their offsets glide to the ordered gait's."""
    gap = (walk.orders.offset - walk.gait.offset + 0.5) % 1.0 - 0.5
    behind = np.minimum(phase_left / (1.0 - GLIDE), phase_left - gap)
    ahead = np.maximum(phase_left / (1.0 + GLIDE), phase_left - gap)
    return np.where(gap < 0.0, behind, ahead)


def excursion(walk, velocity, ways):
    """Largest distance of a foot from its stance, in its room, when it lifts next."""
    gait, worst = walk.gait, 0.0
    for leg, (begin, slack, time) in enumerate(ways):
        if time <= 0.0:
            continue
        stance, place = walk.feet.stance[leg], begin
        if not np.isnan(slack):
            change = stance + 0.5 * stride_of(velocity, stance, gait.duty, gait.frequency) - begin
            far = np.linalg.norm(change[:2])
            place = begin + change * (min(1.0, slack / far) if far > 0.0 else 1.0)
        place, stance = place[:2], stance[:2]
        vx, vy, turn = velocity * time
        if abs(turn) > 1e-6:
            c, s = np.cos(turn), np.sin(turn)
            # The body goes along an arc and turns; a point of the ground is seen from where it ends.
            body = np.array([[s, c - 1.0], [1.0 - c, s]]) @ [vx, vy] / turn
            end = np.array([[c, s], [-s, c]]) @ (place - body)
        else:
            end = place + np.array([-vx + turn * place[1], -vy - turn * place[0]])
        away = end - stance
        if away.any():
            worst = max(worst, np.linalg.norm(away) / max(room(walk, leg, *away), 1e-4))
    return worst


def renew_walkspace(walk):
    space, model, orders = walk.space, walk.model, walk.orders
    posed = (walk.feet.stance - orders.posing_position) @ orders.posing_rotation
    still = (walk.feet.stance - orders.still_position) @ orders.still_rotation
    space.moved = np.linalg.norm(posed - space.middle, axis=1)
    far = np.linalg.norm(still - space.middle, axis=1)
    farthest = int(np.argmax(far))
    if space.leg < 0 and far[farthest] > STALE * model.reach:
        space.leg, space.ray, space.ray_begun, space.begun = farthest, 0, 0, still[farthest]
    if space.leg >= 0:
        search_ray(walk)


def search_ray(walk):
    """Along one ray as far as places are reached, and the first that is not."""
    space, model = walk.space, walk.model
    ends = False
    if not space.ray_begun:
        aim_ray(walk)
        space.ray_begun = 1
        joints, left = reached(walk, space.ray_begin, space.ray_joints, FIRST_ITERATIONS)
        space.ray_joints, ends = joints, left > REACHED * model.reach
    while not ends:
        far, step, halved = space.ray_progress
        if USED * far >= model.farthest:
            ends = True
            break
        joints, left = reached(walk, space.ray_begin + (far + step) * space.ray_along, space.ray_joints)
        if left > REACHED * model.reach or np.abs(joints - space.ray_joints).max() > LARGEST_TURN:
            space.ray_progress = far, 0.5 * step, halved + 1
            ends = halved + 1 > HALVINGS
            break
        space.ray_progress, space.ray_joints = (far + step, step, halved), joints
    if ends:
        end_ray(walk)


def reached(walk, foot, guess, iterations=ITERATIONS):
    """Joints (n,) of the leg under search, at whatever speed, and the distance left, m."""
    model, leg = walk.model, walk.space.leg
    chain = SimpleNamespace(
        dh=model.dh, limits=model.safe_limits, closed_form=model.closed_form, speed_limit=np.inf, dt=1.0
    )
    down, content = np.array([0.0, 0.0, -1.0]), REACHED * model.reach
    return solve_leg(chain, model.hips[leg], model.hip_axes[leg], foot, down, guess, content, iterations)


def aim_ray(walk):
    space, model, turn = walk.space, walk.model, walk.orders.still_rotation
    layer, bearing = divmod(space.ray, BEARINGS)
    angle = 2.0 * np.pi * bearing / BEARINGS
    space.ray_begin = space.begun + turn[2] * model.layers[layer]
    space.ray_along = turn[0] * np.cos(angle) + turn[1] * np.sin(angle)
    space.ray_joints, space.ray_progress = model.standing, (0.0, RADIUS_STEP * model.reach, 0.0)


def end_ray(walk):
    space, model, leg = walk.space, walk.model, walk.space.leg
    layer, bearing = divmod(space.ray, BEARINGS)
    space.reach[leg, layer, bearing] = min(USED * space.ray_progress[0], model.farthest)
    space.ray, space.ray_begun = space.ray + 1, 0
    if space.ray == LAYERS * BEARINGS:
        model.radius[leg] = walkspace_of(walk, leg)
        space.middle[leg] = space.begun
        space.leg = -1


def walkspace_of(walk, leg):
    """Radii (BEARINGS,): within reach at all heights, there and opposite, and nearer than any other stance."""
    radius = walk.space.reach[leg].min(axis=0)
    if not walk.settings.overlapping_walkspaces:
        angles = 2.0 * np.pi * np.arange(BEARINGS) / BEARINGS
        for x, y in np.delete(walk.feet.stance, leg, axis=0)[:, :2] - walk.feet.stance[leg][:2]:
            along = x * np.cos(angles) + y * np.sin(angles)
            ahead = along > 1e-9
            radius = np.where(ahead, np.minimum(radius, 0.5 * (x * x + y * y) / np.where(ahead, along, 1.0)), radius)
    return np.minimum(radius, np.roll(radius, BEARINGS // 2))
