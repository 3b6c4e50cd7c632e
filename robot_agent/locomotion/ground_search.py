"""A foot that finds no ground below looks for it beside: up, across to another place of its walkspace, and down again.

Meanwhile the gait waits, as it does for every foot that still reaches down. Without this the foot hangs over a hole or
an edge, the others are lifted in their turn, and the robot tips onto it.
"""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.stride import foot_velocity
from robot_agent.locomotion.walk_state import Array, Record
from robot_agent.locomotion.walkspace import radius_towards

DOWN, UP, ACROSS = 0, 1, 2
"""What a reaching foot does."""
SPEED = 0.25
"""m/s, upwards and across."""
CLEARANCE = 0.04
"""m above where the foot stood last, and above the ground expected at the place it goes to."""
PLACES = 5
"""Looked at before the foot gives up."""
SHARE = 0.8
"""Of the walkspace's radius, at which places off its middle lie."""


@kernel
def begin_search(walk: Record, leg: int) -> bool:
    """Choose the next place for a foot that has reached as deep as it may; False where there is none left."""
    feet = walk.feet
    if walk.gait.halted or feet.tried[leg] >= PLACES:
        return False
    place_to_try(walk, leg, feet.tried[leg], feet.goal[leg])
    feet.tried[leg] += 1
    feet.seeking[leg] = UP
    return True


@kernel
def place_to_try(walk: Record, leg: int, number: int, goal: Array) -> None:
    """Fill `goal` (2,), m in body: nearer to the body, the middle, ahead, where the foot stood last, farther out."""
    stance, lift_off, way = walk.feet.stance[leg], walk.feet.lift_off[leg], np.zeros(3)
    share, inwards = SHARE, -1.0 if stance[1] > 0.0 else 1.0
    if number == 0:
        way[1] = inwards
    elif number == 1:
        share = 0.0
    elif number == 2:
        foot_velocity(walk.gait.limited, stance, way)
        way[0], way[1] = -way[0], -way[1]
    elif number == 3:
        way[0], way[1] = lift_off[0] - stance[0], lift_off[1] - stance[1]
    else:
        way[1] = -inwards
    far = np.sqrt(way[0] * way[0] + way[1] * way[1])
    room = max(radius_towards(walk.model.radius[leg], way[0], way[1]) - walk.space.moved[leg], 0.0)
    length = min(share * room, far) if number == 3 else share * room
    for k in range(2):
        goal[k] = stance[k] + (length / far * way[k] if far > 1e-9 else 0.0)


@kernel
def seek(walk: Record, leg: int) -> None:
    """Move a seeking foot by one tick. A touch on the way across is something that stands there: up along it."""
    feet, step = walk.feet, SPEED * walk.model.dt
    place, goal, plane = feet.place[leg], feet.goal[leg], walk.body.plane
    expected = plane[0] * goal[0] + plane[1] * goal[1] + plane[2]
    highest = max(feet.stance[leg, 2] + walk.model.headroom[leg], place[2])
    if walk.gait.halted:
        feet.seeking[leg] = DOWN
    elif feet.seeking[leg] == UP:
        top = min(max(feet.lift_off[leg, 2], expected) + CLEARANCE, highest)
        place[2] = min(place[2] + step, max(top, place[2]))
        if place[2] >= top:
            feet.seeking[leg] = ACROSS
    elif walk.senses.contact[leg] and place[2] < highest:
        place[2] = min(place[2] + step, highest)
    else:
        x, y = goal[0] - place[0], goal[1] - place[1]
        far = np.sqrt(x * x + y * y)
        share = min(1.0, step / max(far, 1e-9))
        place[0], place[1] = place[0] + share * x, place[1] + share * y
        if far <= step or walk.senses.contact[leg]:
            feet.seeking[leg] = DOWN
    if feet.seeking[leg] == DOWN:
        feet.reached[leg] = expected - place[2]
