"""Walkspaces follow the stances: posing, another height or a shift of the body changes what the legs can reach.

At once every radius is taken less by as far as its stance has moved, which is always safe. Behind that the workspace
is searched anew, one leg after the other, the one that has moved farthest first; where the body only moves to and fro
with the gait, there is nothing to search. A tick searches along a ray as far as
everything is within reach: a place that is not is costly to find out, so the next one is tried in the next tick.
"""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import BEARINGS, LAYERS, Array, Record
from robot_agent.locomotion.walkspace import fill_walkspace
from robot_agent.locomotion.workspace import FAR, USED, begin_ray, extend_ray

STALE = 0.01
"""Of the leg's length, that a stance moves before its workspace is searched anew."""


@kernel
def renew_walkspace(walk: Record) -> None:
    """One tick: how far every stance has moved, and more of a ray where that is too far."""
    space, orders, middle = walk.space, walk.orders, np.empty(3)
    farthest, next_leg = STALE * walk.model.reach, -1
    for leg in range(walk.model.legs):
        place = walk.feet.stance[leg]
        seen_from(orders.posing_rotation, orders.posing_position, place, middle)
        space.moved[leg] = distance(middle, space.middle[leg])
        seen_from(orders.still_rotation, orders.still_position, place, middle)
        far = distance(middle, space.middle[leg])
        if far > farthest:
            farthest, next_leg = far, leg
    if space.leg < 0 and next_leg >= 0:
        space.leg, space.ray, space.ray_begun = next_leg, 0, False
        seen_from(orders.still_rotation, orders.still_position, walk.feet.stance[next_leg], space.begun)
    if space.leg >= 0:
        _search_ray(walk)


@kernel
def distance(a: Array, b: Array) -> float:
    """Between two places (3,)."""
    between: float = np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
    return between


@kernel
def seen_from(turn: Array, shift: Array, place: Array, result: Array) -> None:
    """Fill `result` (3,) with a place of the un-posed body, seen from one posed by `turn` (3, 3) and `shift` (3,)."""
    for k in range(3):
        result[k] = 0.0
        for i in range(3):
            result[k] += turn[i, k] * (place[i] - shift[i])


@kernel
def _search_ray(walk: Record) -> None:
    space, model = walk.space, walk.model
    leg, n, ends = space.leg, model.joints, False
    if not space.ray_begun:
        _aim_ray(walk)
        space.ray_begun = True
        ends = not begin_ray(
            model.dh[:n], model.safe_limits[:n], model.closed_form, model.hips[leg], model.hip_axes[leg],
            space.ray_begin, space.ray_joints[:n], space.ray_progress,
        )  # fmt: skip
    ends = ends or extend_ray(
        model.dh[:n], model.safe_limits[:n], model.closed_form, model.hips[leg], model.hip_axes[leg],
        space.ray_begin, space.ray_along, model.farthest, space.ray_joints[:n], space.ray_progress,
    )  # fmt: skip
    if ends:
        _end_ray(walk)


@kernel
def _aim_ray(walk: Record) -> None:
    """The ray's beginning and direction in the posed body of now, and where the search for joints begins."""
    space, model, turn = walk.space, walk.model, walk.orders.still_rotation
    layer, bearing = divmod(space.ray, BEARINGS)
    angle = 2.0 * np.pi * bearing / BEARINGS
    for k in range(3):
        space.ray_begin[k] = space.begun[k] + turn[2, k] * model.layers[layer]
        space.ray_along[k] = turn[0, k] * np.cos(angle) + turn[1, k] * np.sin(angle)
    for i in range(model.joints):
        space.ray_joints[i] = model.standing[i]


@kernel
def _end_ray(walk: Record) -> None:
    """Keep the ray's length; behind the last ray, take the leg's new workspace into use."""
    space, model, leg = walk.space, walk.model, walk.space.leg
    layer, bearing = divmod(space.ray, BEARINGS)
    space.reach[leg, layer, bearing] = min(USED * space.ray_progress[FAR], model.farthest)
    space.ray_begun = False
    space.ray += 1
    if space.ray == LAYERS * BEARINGS:
        stances = walk.feet.stance[: model.legs]
        fill_walkspace(space.reach[leg], stances, leg, walk.settings.overlapping_walkspaces != 0, model.radius[leg])
        space.middle[leg, :] = space.begun
        space.leg = -1
