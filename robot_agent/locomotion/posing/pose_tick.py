"""One tick of the body's pose against its un-posed place: levelling, then the operator's, then the gait's own.

    unposed_from_body = levelling @ manual @ automatic

Each part comes and goes through a slew; `slews` (3, 2 + rows, 6) holds each one's rate-limited value, its answer, and
the last inputs of its two means (see `slew`).
"""

from math import cos, sin

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.posing.automatic import sway
from robot_agent.locomotion.posing.levelling import clear_levelling, hold_levelling, step_levelling, tilt_error
from robot_agent.locomotion.posing.slew import follow
from robot_agent.locomotion.reasons import GRAVITY
from robot_agent.locomotion.walk_state import Array, Record

MANUAL, LEVEL, FADE = 0, 1, 2
LIMITED, VALUE, MEANS = 0, 1, 2


@kernel
def pose_body(walk: Record, slews: Array) -> None:
    """Set how the body is posed in this tick."""
    posing, orders = walk.posing, walk.orders
    rotation, position = orders.posing_rotation, orders.posing_position
    turn, place, wanted = np.empty((3, 3)), np.empty(3), np.zeros(6)
    slew(posing, slews, MANUAL, posing.manual)
    to_pose(slews[MANUAL, VALUE], rotation, position)
    wanted[0] = 1.0 if posing.automatic and walk.gait.walking else 0.0
    slew(posing, slews, FADE, wanted)
    fade = slews[FADE, VALUE, 0]
    posing.fade = fade
    still_turn, still_place = rotation.copy(), position.copy()
    if fade != 0.0:
        gait, values = walk.gait, np.empty(6)
        legs = walk.model.legs
        sway(
            gait.leg_phase[:legs], 1.0 - gait.duty, posing.ahead, posing.amplitude, posing.slope, posing.rates,
            gait.frequency, values,
        )  # fmt: skip
        for k in range(6):
            values[k] *= fade
        to_pose(values, turn, place)
        append(rotation, position, turn, place)
    wanted[0] = 0.0
    if posing.levelling:
        if walk.answer.reasons & GRAVITY:
            hold_levelling(posing)
        else:
            error = np.empty(2)
            tilt_error(rotated(rotation, walk.senses.up), error)
            step_levelling(posing, error, walk.model.dt)
        wanted[3], wanted[4] = posing.turn[0], posing.turn[1]
    else:
        clear_levelling(posing)
    slew(posing, slews, LEVEL, wanted)
    to_pose(slews[LEVEL, VALUE], turn, place)
    orders.still_rotation[:] = turn
    orders.still_position[:] = place
    append(orders.still_rotation, orders.still_position, still_turn, still_place)
    append(turn, place, rotation, position)
    rotation[:] = turn
    position[:] = place
    rest(walk, slews)


@kernel
def rest(walk: Record, slews: Array) -> None:
    """Be exactly un-posed once nothing is wanted and nothing moves."""
    posing, orders = walk.posing, walk.orders
    longest = slews.shape[1] - MEANS
    posing.idle = not posing.wanted
    for which in range(3):
        posing.idle = posing.idle and posing.still[which] > longest
    if posing.idle:
        orders.posing_rotation[:] = orders.still_rotation[:] = np.eye(3)
        orders.posing_position[:] = orders.still_position[:] = 0.0


@kernel
def slew(posing: Record, slews: Array, which: int, wanted: Array) -> None:
    """One tick of a slew towards `wanted` (6,); one at rest costs nothing."""
    own, first = slews[which], MEANS + posing.first
    if posing.still[which] > own.shape[0] - MEANS and (wanted == own[LIMITED]).all():
        return
    means = own[MEANS:first], own[first:]
    moved = follow(
        wanted, posing.steps[which], own[LIMITED], means[0], means[1], posing.ticks[which], own[VALUE]
    )  # fmt: skip
    posing.still[which] = 0 if moved else posing.still[which] + 1
    posing.ticks[which] += 1


@kernel
def to_pose(values: Array, rotation: Array, position: Array) -> None:
    """Fill a pose from x, y, z (m), roll, pitch, yaw (rad): Rz Ry Rx."""
    cr, sr, cp, sp = cos(values[3]), sin(values[3]), cos(values[4]), sin(values[4])
    cy, sy = cos(values[5]), sin(values[5])
    rotation[0, 0], rotation[0, 1], rotation[0, 2] = cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr
    rotation[1, 0], rotation[1, 1], rotation[1, 2] = sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr
    rotation[2, 0], rotation[2, 1], rotation[2, 2] = -sp, cp * sr, cp * cr
    for k in range(3):
        position[k] = values[k]


@kernel
def append(rotation: Array, position: Array, turn: Array, place: Array) -> None:
    """Put the pose (turn, place) behind the pose (rotation, position), in place."""
    x, y, z = place
    for i in range(3):
        a, b, c = rotation[i, 0], rotation[i, 1], rotation[i, 2]
        for k in range(3):
            rotation[i, k] = a * turn[0, k] + b * turn[1, k] + c * turn[2, k]
        position[i] += a * x + b * y + c * z


@kernel
def rotated(rotation: Array, vector: Array) -> Array:
    """`vector` (3,) turned."""
    result = np.empty(3)
    for i in range(3):
        result[i] = rotation[i, 0] * vector[0] + rotation[i, 1] * vector[1] + rotation[i, 2] * vector[2]
    return result
