"""Room for every foot: walkspaces about stances that move, kept up one ray a tick."""

import numpy as np

from robot_agent.locomotion.walk_state import BEARINGS, LAYERS
from robot_agent.locomotion.walkspace_renewal import STALE
from robot_agent.locomotion.workspace import length_of_ray


def room(walk, leg, x, y):
    """m that a foot may be from its stance in the direction (x, y)."""
    radius = walk.model.radius[leg]
    place = np.arctan2(y, x) % (2.0 * np.pi) / (2.0 * np.pi) * radius.size
    towards = np.interp(place, np.arange(radius.size + 1), np.append(radius, radius[0]))
    return max(towards - walk.space.moved[leg], 0.0)


def excursion(walk, velocity, time_left):
    """Largest distance of a foot from its stance, in its room, when it lifts in `time_left` (legs,) s."""
    worst = 0.0
    for leg, time in enumerate(time_left):
        if time <= 0.0:
            continue
        place, stance = walk.feet.place[leg][:2], walk.feet.stance[leg][:2]
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
    space, model = walk.space, walk.model
    posed = (walk.feet.stance - walk.orders.posing_position) @ walk.orders.posing_rotation
    space.moved = np.linalg.norm(posed - space.middle, axis=1)
    farthest = int(np.argmax(space.moved))
    if space.leg < 0 and space.moved[farthest] > STALE * model.reach:
        space.leg, space.ray, space.begun = farthest, 0, posed[farthest]
    if space.leg >= 0:
        search_ray(walk)


def search_ray(walk):
    space, model = walk.space, walk.model
    layer, bearing = divmod(space.ray, BEARINGS)
    angle, turn, leg = 2.0 * np.pi * bearing / BEARINGS, walk.orders.posing_rotation, space.leg
    # One ray is a search by inverse kinematics, which has a reference of its own.
    space.reach[leg, layer, bearing] = length_of_ray(
        model.dh,
        model.safe_limits,
        model.closed_form,
        model.hips[leg],
        model.hip_axes[leg],
        space.begun + turn[2] * model.layers[layer],
        turn[0] * np.cos(angle) + turn[1] * np.sin(angle),
        model.farthest,
        model.standing,
    )
    space.ray += 1
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
