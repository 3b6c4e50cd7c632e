"""How the body moves over its feet in a tick: the walking velocity and what height, attitude and inclination need."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import HANG
from robot_agent.locomotion.ground_plane import fit_plane
from robot_agent.locomotion.posture import attitude_rate, height_rate, support_shift, wanted_up
from robot_agent.locomotion.walk_state import Array, Record

HANGING_WEIGHT = 0.1


@kernel
def move_body(walk: Record) -> None:
    """Twist of the body over the ground, from where the feet stand and the walking velocity, all un-posed."""
    config, body, model, senses = walk.settings.posture, walk.body, walk.model, walk.senses
    wanted, rate, shift = np.empty(3), np.empty(2), np.empty(2)
    up = senses.unposed_up
    follow_plane(walk)
    wanted_up(up, body.plane, config.follow_ground, wanted)
    attitude_rate(wanted, config.attitude_gain, config.attitude_rate, config.attitude_dead_band, rate)
    rise = height_rate(body.plane, model.foot_depth, config.height_gain, config.height_rate, config.height_dead_band)
    height = model.foot_depth + senses.unposed_centre[2]
    support_shift(up, height, config.shift_fraction, config.largest_shift, shift)
    _compose(walk, rate, rise, shift)


@kernel
def follow_plane(walk: Record) -> None:
    """Low-pass the plane through the feet; one that hangs over a hole hardly counts."""
    legs, body, blend = walk.model.legs, walk.body, walk.model.plane_blend
    weight, fresh = np.empty(legs), np.empty(3)
    for leg in range(legs):
        weight[leg] = HANGING_WEIGHT if walk.feet.mode[leg] == HANG else 1.0
    fresh[:] = body.plane
    walk.answer.residual = fit_plane(walk.feet.anchor[:legs], weight, fresh)
    for k in range(3):
        body.plane[k] += blend * (fresh[k] - body.plane[k])


@kernel
def _compose(walk: Record, attitude: Array, rise: float, wanted_shift: Array) -> None:
    """Posture's twist, then posture and walking together: walking climbs with the ground's slope."""
    body, velocity, dt = walk.body, walk.gait.velocity, walk.model.dt
    largest = walk.settings.posture.shift_rate * dt
    for k in range(2):
        change = min(max(wanted_shift[k] - body.shift[k], -largest), largest)
        body.shift[k] += change
        body.linear[k] = -change / dt
        body.angular[k] = attitude[k]
        body.whole_linear[k] = body.linear[k] + velocity[k]
        body.whole_angular[k] = body.angular[k]
    body.linear[2] = rise
    body.whole_linear[2] = rise + body.plane[0] * velocity[0] + body.plane[1] * velocity[1]
    body.whole_angular[2] = velocity[2]
