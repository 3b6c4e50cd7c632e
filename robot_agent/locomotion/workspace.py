"""How far a foot may travel about its stance, in every direction, over the range of ground heights."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.kinematics.compiled import kernel
from robot_agent.kinematics.inverse import solve_leg

Array = NDArray[np.float64]

BEARINGS = 36
RADIUS_STEP = 0.012
"""Of the leg's length."""
REACHED = 0.003
"""Distance left, of the leg's length, at which a place counts as reached."""
LIMIT_MARGIN = 0.05
"""rad kept from every joint limit."""


def reachable_radius(model: LegModel, stance_in_body: Array, heights: Array, largest: float) -> Array:
    """Radius (legs, BEARINGS), m, within which a foot is reachable at all `heights` (m above the stance).

    Bearing i is 360 i / BEARINGS degrees from the body's x axis. The radius is the smaller of a bearing and its
    opposite, since a stride is centred on the stance.
    """
    limits = model.limits_less(LIMIT_MARGIN)
    radius = np.zeros((model.leg_count, BEARINGS))
    _fill(
        model.dh,
        limits,
        model.closed_form,
        model.hips,
        model.hip_axes,
        stance_in_body,
        heights,
        largest,
        model.standing,
        radius,
    )
    opposite: Array = np.minimum(radius, np.roll(radius, BEARINGS // 2, axis=1))
    return opposite


@kernel
def _fill(
    dh: Array,
    limits: Array,
    closed_form: int,
    hips: Array,
    hip_axes: Array,
    stance: Array,
    heights: Array,
    largest: float,
    standing: Array,
    radius: Array,
) -> None:
    n = dh.shape[0]
    down = np.array([0.0, 0.0, -1.0])
    joints, guess, foot = np.zeros(n), np.zeros(n), np.zeros(3)
    reach = np.abs(dh[:, 1:3]).sum()
    step = RADIUS_STEP * reach
    for leg in range(hips.shape[0]):
        for bearing in range(radius.shape[1]):
            angle = 2.0 * np.pi * bearing / radius.shape[1]
            reached = largest
            for height in heights:
                for i in range(n):
                    guess[i] = standing[i]
                far = 0.0
                while far < reached:
                    foot[0] = stance[leg, 0] + (far + step) * np.cos(angle)
                    foot[1] = stance[leg, 1] + (far + step) * np.sin(angle)
                    foot[2] = stance[leg, 2] + height
                    left = solve_leg(dh, limits, closed_form, hips[leg], hip_axes[leg], foot, down, guess, joints)
                    if left > REACHED * reach:
                        break
                    guess[:] = joints
                    far += step
                reached = min(reached, far)
            radius[leg, bearing] = reached


@kernel
def radius_towards(radius: Array, x: float, y: float) -> float:
    """Radius of one leg (BEARINGS,) in the direction (x, y), linear between bearings."""
    place = np.arctan2(y, x) / (2.0 * np.pi) * radius.size
    lower = np.floor(place)
    share = place - lower
    first = int(lower) % radius.size
    towards: float = (1.0 - share) * radius[first] + share * radius[(first + 1) % radius.size]
    return towards


@kernel
def velocity_scale(
    velocity: Array, stance: Array, radius: Array, duty: float, frequency: float, largest_stride: float
) -> float:
    """Largest factor, at most 1, by which `velocity` (vx, vy, turn) keeps every leg's stride within its radius."""
    scale = 1.0
    for leg in range(stance.shape[0]):
        x = velocity[0] - velocity[2] * stance[leg, 1]
        y = velocity[1] + velocity[2] * stance[leg, 0]
        half = 0.5 * np.sqrt(x * x + y * y) * duty / frequency
        if half > 0.0:
            scale = min(scale, min(radius_towards(radius[leg], x, y), 0.5 * largest_stride) / half)
    return scale
