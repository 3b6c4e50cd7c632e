"""The walker's tick once more in plain numpy, a stage a file: what the kernels are compared with.

Stages work on a `Walk`, a view of the walker's memory, in place, and are written to be read, not to be fast.
"""

import numpy as np

from numpy_tick.body import move_body
from numpy_tick.feet import carry_feet, move_swinging, take_anchors
from numpy_tick.gait import advance, start_or_stop
from numpy_tick.legs import follow_angles, place_feet, reach_feet
from numpy_tick.load import carry_load, give_way
from numpy_tick.margins import judge
from numpy_tick.memory import Walk
from numpy_tick.orders import clean_velocity, follow_parameters, follow_velocity, walked_velocity
from numpy_tick.posing import pose_body
from numpy_tick.senses import sense
from numpy_tick.walkspace import renew_walkspace

__all__ = ["Walk", "answer", "tick"]


def tick(walk, slews=None):
    """A whole tick of a robot on its legs; with `slews` its body is posed."""
    walk.answer.reasons = 0
    sense(walk)
    clean_velocity(walk)
    follow_parameters(walk)
    judge(walk)
    walk.joint.previous = walk.joint.wanted
    walk.feet.stance = walk.model.stance + np.array([*walk.body.shift, 0.0])
    renew_walkspace(walk)
    follow_velocity(walk)
    start_or_stop(walk)
    if walk.gait.walking:
        advance(walk)
    walked_velocity(walk)
    move_body(walk)
    carry_feet(walk)
    move_swinging(walk)
    take_anchors(walk)
    carry_load(walk)
    if walk.settings.feel_ground:
        give_way(walk)
    if slews is not None:
        pose_body(walk, slews)
    place_feet(walk)
    reach_feet(walk)
    follow_angles(walk)
    answer(walk)


def answer(walk):
    """What others are told."""
    told, swinging = walk.answer, (1, 2)
    walk.feet.in_air = [mode in swinging for mode in walk.feet.mode]
    told.velocity, told.plane = walk.gait.velocity, walk.body.plane
    told.force, told.phase, told.swing = walk.senses.force, walk.gait.leg_phase, walk.feet.in_air
    told.posing_rotation, told.posing_position = walk.orders.posing_rotation, walk.orders.posing_position
    told.foot, told.joint_position = walk.joint.foot, walk.joint.target
