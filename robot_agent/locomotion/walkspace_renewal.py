"""Walkspaces follow the stances: posing, another height or a shift of the body changes what the legs can reach.

At once every radius is taken less by as far as its stance has moved, which is always safe. Behind that the workspace
is searched anew, one ray a tick and one leg after the other, the one that has moved farthest first.
"""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import BEARINGS, LAYERS, Array, Record
from robot_agent.locomotion.walkspace import fill_walkspace
from robot_agent.locomotion.workspace import length_of_ray

STALE = 0.01
"""Of the leg's length, that a stance moves before its workspace is searched anew."""


@kernel
def renew_walkspace(walk: Record) -> None:
    """One tick: how far every stance has moved, and one more ray where that is too far."""
    space, middle = walk.space, np.empty(3)
    farthest, next_leg = STALE * walk.model.reach, -1
    for leg in range(walk.model.legs):
        into_posed(walk, walk.feet.stance[leg], middle)
        away = 0.0
        for k in range(3):
            away += (middle[k] - space.middle[leg, k]) ** 2
        space.moved[leg] = np.sqrt(away)
        if space.moved[leg] > farthest:
            farthest, next_leg = space.moved[leg], leg
    if space.leg < 0 and next_leg >= 0:
        space.leg, space.ray = next_leg, 0
        into_posed(walk, walk.feet.stance[next_leg], space.begun)
    if space.leg >= 0:
        _search_ray(walk)


@kernel
def into_posed(walk: Record, place: Array, result: Array) -> None:
    """Fill `result` (3,) with a place of the un-posed body, seen from the posed one."""
    turn, shift = walk.orders.posing_rotation, walk.orders.posing_position
    for k in range(3):
        result[k] = 0.0
        for i in range(3):
            result[k] += turn[i, k] * (place[i] - shift[i])


@kernel
def _search_ray(walk: Record) -> None:
    space, model, turn = walk.space, walk.model, walk.orders.posing_rotation
    layer, bearing = divmod(space.ray, BEARINGS)
    angle, n, leg = 2.0 * np.pi * bearing / BEARINGS, model.joints, space.leg
    begin, along = np.empty(3), np.empty(3)
    for k in range(3):
        begin[k] = space.begun[k] + turn[2, k] * model.layers[layer]
        along[k] = turn[0, k] * np.cos(angle) + turn[1, k] * np.sin(angle)
    space.reach[leg, layer, bearing] = length_of_ray(
        model.dh[:n],
        model.safe_limits[:n],
        model.closed_form,
        model.hips[leg],
        model.hip_axes[leg],
        begin,
        along,
        model.farthest,
        model.standing[:n],
    )
    space.ray += 1
    if space.ray == LAYERS * BEARINGS:
        stances = walk.feet.stance[: model.legs]
        fill_walkspace(space.reach[leg], stances, leg, walk.settings.overlapping_walkspaces != 0, model.radius[leg])
        space.middle[leg, :] = space.begun
        space.leg = -1
