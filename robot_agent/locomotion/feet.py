"""Where each foot belongs: it stands and is left behind by the body, or swings, reaches for the ground and lands.

A standing foot keeps the height it found. A swinging foot that touches early stops there; one that is late goes on
down, up to a limit, while the gait waits.
"""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.stride import foot_velocity, stride_of, swing_nodes, swing_point

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

STAND, SWING, REACH, HANG = 0, 1, 2, 3
"""HANG: reached as far as it may without finding ground; carries nothing until its next swing."""


class Feet:
    """State of all feet, in body coordinates."""

    def __init__(self, legs: int) -> None:
        self.mode = np.zeros(legs, dtype=np.int64)
        self.place = np.zeros((legs, 3))  # wanted foot centre, before the admittance
        self.lift_off = np.zeros((legs, 3))
        self.anchor = np.zeros((legs, 3))  # where each foot last stood, measured, carried along by the body's motion
        self.lifted = np.zeros(legs, dtype=np.bool_)  # has already swung in this stride
        self.swing_height = np.zeros(legs)
        self.reached = np.zeros(legs)  # m below the expected ground

    def stand_at(self, places: Array) -> None:
        self.mode[:] = STAND
        self.place[:] = places
        self.anchor[:] = places
        self.lifted[:] = False


@kernel
def carry(points: Array, linear: Array, angular: Array, dt: float) -> None:
    """Move `points` (n, 3), fixed to the ground, as a body sees them that moves with a twist (m/s, rad/s in body).

    The turn is applied exactly, so long walks do not stretch the stance.
    """
    angle = np.sqrt(angular[0] ** 2 + angular[1] ** 2 + angular[2] ** 2) * dt
    sine, versine = 1.0, 0.5
    if angle > 1e-9:
        sine, versine = np.sin(angle) / angle, (1.0 - np.cos(angle)) / (angle * angle)
    wx, wy, wz = -angular[0] * dt, -angular[1] * dt, -angular[2] * dt
    for i in range(points.shape[0]):
        x, y, z = points[i, 0] - linear[0] * dt, points[i, 1] - linear[1] * dt, points[i, 2] - linear[2] * dt
        cx, cy, cz = wy * z - wz * y, wz * x - wx * z, wx * y - wy * x
        points[i, 0] = x + sine * cx + versine * (wy * cz - wz * cy)
        points[i, 1] = y + sine * cy + versine * (wz * cx - wx * cz)
        points[i, 2] = z + sine * cz + versine * (wx * cy - wy * cx)


@kernel
def carry_standing(mode: NDArray[np.int64], place: Array, linear: Array, angular: Array, dt: float) -> None:
    """`carry` for the feet on the ground alone."""
    for leg in range(mode.size):
        if mode[leg] == STAND or mode[leg] == HANG:
            carry(place[leg : leg + 1], linear, angular, dt)


@kernel
def count_mode(mode: NDArray[np.int64], wanted: int) -> int:
    """How many feet are in a mode."""
    count = 0
    for leg in range(mode.size):
        count += mode[leg] == wanted
    return count


@kernel
def until_next_lift(mode: NDArray[np.int64], lifted: Flags, leg_phase: Array, swing: float) -> float:
    """Fraction of a stride until the next foot is due to lift off."""
    least = 1.0
    for leg in range(mode.size):
        if leg_phase[leg] >= swing or (not lifted[leg] and (mode[leg] == STAND or mode[leg] == HANG)):
            least = min(least, 1.0 - leg_phase[leg])
    return least


@kernel
def take_anchors(
    mode: NDArray[np.int64], contact: Flags, measured: Array, place: Array, feel_ground: bool, anchor: Array
) -> None:
    """Standing feet are where they are measured to be; without a sense of ground, where they are wanted."""
    for leg in range(mode.size):
        if mode[leg] == STAND and (contact[leg] or not feel_ground):
            for k in range(3):
                anchor[leg, k] = measured[leg, k] if feel_ground else place[leg, k]


@kernel
def lift(
    leg: int, mode: NDArray[np.int64], place: Array, lift_off: Array, offset: Array, up: Array, height: float,
    swing_height: Array, lifted: Flags, reached: Array,
) -> None:  # fmt: skip
    """Begin a swing where the foot really is: the impedance's offset (legs, 2) goes into the path, and is cleared."""
    for k in range(3):
        place[leg, k] += offset[leg, 0] * up[k]
        lift_off[leg, k] = place[leg, k]
    offset[leg, 0], offset[leg, 1] = 0.0, 0.0
    mode[leg] = SWING
    swing_height[leg] = height
    lifted[leg] = True
    reached[leg] = 0.0


@kernel
def move_swinging(
    mode: NDArray[np.int64],
    place: Array,
    lift_off: Array,
    stance: Array,
    plane: Array,
    up: Array,
    velocity: Array,
    pace: float,
    swing_height: Array,
    reached: Array,
    contact: Flags,
    leg_phase: Array,
    duty: float,
    frequency: float,
    touchdown_speed: float,
    reach_down: float,
    earliest_contact: float,
    feel_ground: bool,
    dt: float,
    lowest: float,
    highest: float,
) -> int:
    """Move every foot in the air by one tick; returns how many still reach for the ground.

    `stance` (legs, 3) is the middle of each foot's stance, `plane` (3,) the expected ground, `leg_phase` (legs,) 0 at
    lift-off. The body moves with `pace` times `velocity`; paths are planned for full pace, since the gait slows with
    the body. Footholds stay between `lowest` and `highest`, z in body.
    """
    first, second = np.empty((5, 3)), np.empty((5, 3))
    foothold, ground, stride = np.empty(3), np.empty(3), np.empty(3)
    reaching = 0
    swing = 1.0 - duty
    for leg in range(mode.size):
        if mode[leg] != SWING and mode[leg] != REACH:
            continue
        progress = leg_phase[leg] / swing
        touches = feel_ground and contact[leg]
        if mode[leg] == SWING and touches and earliest_contact < progress:
            mode[leg] = STAND
            continue
        foot_velocity(velocity, stance[leg], ground)
        if mode[leg] == SWING and (progress < 1.0 or not feel_ground):
            stride_of(velocity, stance[leg], duty, frequency, stride)
            for k in range(2):
                foothold[k] = stance[leg, k] + 0.5 * stride[k]
            z = plane[0] * foothold[0] + plane[1] * foothold[1] + plane[2]
            foothold[2] = min(max(z, lowest), highest)
            half_time = 0.5 * swing / frequency
            if progress >= 1.0:
                for k in range(3):
                    place[leg, k] = foothold[k] + ground[k] * (progress - 1.0) * 2.0 * half_time
                mode[leg] = STAND
                continue
            speed = touchdown_speed if feel_ground else 0.0
            swing_nodes(lift_off[leg], foothold, up, swing_height[leg], ground, speed, half_time, first, second)
            swing_point(progress, first, second, place[leg])
            continue
        if touches:
            mode[leg] = STAND
            continue
        mode[leg] = REACH
        for k in range(3):
            place[leg, k] += (pace * ground[k] - touchdown_speed * up[k]) * dt
        reached[leg] += touchdown_speed * dt
        if reached[leg] > reach_down or place[leg, 2] < lowest:
            mode[leg] = HANG
        else:
            reaching += 1
    return reaching
