"""How far feet will be from their stances when they lift next, if the body keeps a velocity.

A standing foot goes on from where it is. A swinging one from its foothold, which still follows the velocity, but no
faster than `FOOTHOLD_SPEED`: an order that changes shortly before a foot lands finds it in the wrong place.
"""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import FOOTHOLD_SPEED, REACH, STAND, SWING
from robot_agent.locomotion.gait_clock import GLIDE, offset_gap
from robot_agent.locomotion.walk_state import Array, Record
from robot_agent.locomotion.walkspace import radius_towards

X, Y, SLACK, TIME = 0, 1, 2, 3
"""Of a way: from where, m in body; how far that may be moved, m, negative for a foot that stands; for how long, s."""
LEAST_ROOM = 1e-4
"""m."""


@kernel
def ways_left(walk: Record, ways: Array) -> None:
    """Fill `ways` (legs, 4); those of feet that do not count take no time."""
    gait, feet = walk.gait, walk.feet
    for leg in range(walk.model.legs):
        phase = gait.leg_phase[leg]
        until_lift = strides_until(walk, leg, 1.0 - phase) / gait.frequency
        ways[leg, TIME] = 0.0
        if feet.mode[leg] == SWING and feet.planned[leg] and not feet.aimed[leg]:
            landing = strides_until(walk, leg, max(1.0 - gait.duty - phase, 0.0)) / gait.frequency
            ways[leg, X], ways[leg, Y] = feet.foothold[leg, 0], feet.foothold[leg, 1]
            ways[leg, SLACK], ways[leg, TIME] = FOOTHOLD_SPEED * landing, until_lift - landing
        elif feet.mode[leg] == STAND or feet.mode[leg] == REACH:
            lifts_now = phase < 1.0 - gait.duty and not feet.lifted[leg]
            ways[leg, X], ways[leg, Y] = feet.place[leg, 0], feet.place[leg, 1]
            ways[leg, SLACK], ways[leg, TIME] = -1.0, 0.0 if lifts_now else until_lift


@kernel
def strides_until(walk: Record, leg: int, phase_left: float) -> float:
    """Strides in which a leg's phase goes on by `phase_left`, while its offset glides to that of the ordered gait."""
    gap = offset_gap(walk, leg)
    strides: float = max(phase_left / (1.0 + GLIDE), phase_left - gap)
    if gap < 0.0:
        strides = min(phase_left / (1.0 - GLIDE), phase_left - gap)
    return strides


@kernel
def largest_excursion(walk: Record, velocity: Array, ways: Array) -> float:
    """Of all feet at the end of their `ways` (legs, 4): the largest distance from the stance, over the room there."""
    worst = 0.0
    for leg in range(walk.model.legs):
        if ways[leg, TIME] > 0.0:
            worst = max(worst, _excursion(walk, leg, velocity, ways[leg]))
    return worst


@kernel
def _excursion(walk: Record, leg: int, velocity: Array, way: Array) -> float:
    stance, time = walk.feet.stance[leg], way[TIME]
    x, y = way[X], way[Y]
    if way[SLACK] >= 0.0:
        half = 0.5 * walk.gait.duty / walk.gait.frequency
        change_x = stance[0] + half * (velocity[0] - velocity[2] * stance[1]) - x
        change_y = stance[1] + half * (velocity[1] + velocity[2] * stance[0]) - y
        far = np.sqrt(change_x * change_x + change_y * change_y)
        share = way[SLACK] / far if far > way[SLACK] else 1.0
        x, y = x + share * change_x, y + share * change_y
    angle = -velocity[2] * time
    sine, versine = 1.0, 0.5 * angle
    if abs(angle) > 1e-6:
        sine, versine = np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle
    # the twist's exponential: the way of the body, turned along the arc
    vx, vy = (-velocity[0] + velocity[2] * y) * time, (-velocity[1] - velocity[2] * x) * time
    x, y = x + sine * vx - versine * vy - stance[0], y + versine * vx + sine * vy - stance[1]
    far = np.sqrt(x * x + y * y)
    if far == 0.0:
        return 0.0
    away: float = far / max(radius_towards(walk.model.radius[leg], x, y) - walk.space.moved[leg], LEAST_ROOM)
    return away
