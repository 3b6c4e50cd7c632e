"""Where a leg can put its foot: how far from its stance, in every direction, at several heights of the ground.

A ray ends where the joints are at their limits, and before a leg is so nearly stretched that its foot becomes slow. It
is searched outwards, every place from the joints of the one before, so that a foot can go all the way in one posture;
`extend_ray` can be left and taken up again.
"""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.kinematics.compiled import kernel
from robot_agent.kinematics.inverse import solve_leg_to

Array = NDArray[np.float64]

BEARINGS = 36
"""Bearing i is 360 i / BEARINGS degrees from the body's x axis."""
RADIUS_STEP = 0.06
"""Of the leg's length; an arc about the hip rises by a thousandth of it between two places so far apart."""
HALVINGS = 6
"""Of the last step, the one that was not reached any more."""
FAR, STEP, HALVED = 0, 1, 2
"""Of a ray's progress: m within reach, m of the next step, and how often that was halved."""
REACHED = 0.003
"""Distance left, of the leg's length, at which a place counts as reached."""
LIMIT_MARGIN = 0.05
"""rad kept from every joint limit."""
ITERATIONS = 8
"""For one place; a leg that has not got there by then is at its limits, and gets there by chance if at all."""
FIRST_ITERATIONS = 60
"""For a ray's beginning, which is searched from farther off."""
USED = 0.9
"""Of the reach; beyond, legs are nearly stretched and their feet slow."""
LARGEST_TURN = 0.5
"""rad of a joint in one step; more means that the joints change over to another posture."""


def workspace(model: LegModel, stance_in_body: Array, heights: Array, largest: float) -> Array:
    """Radius (legs, heights, BEARINGS), m, up to which a foot is within reach, `largest` at most.

    `stance_in_body` (legs, 3) is the middle, `heights` (m) are above it.
    """
    radius = np.zeros((model.leg_count, len(heights), BEARINGS))
    _fill(
        model.dh,
        model.limits_less(LIMIT_MARGIN),
        model.closed_form,
        model.hips,
        model.hip_axes,
        np.asarray(stance_in_body, dtype=np.float64),
        np.asarray(heights, dtype=np.float64),
        largest,
        model.standing,
        radius,
    )
    return radius


def headroom(model: LegModel, stance_in_body: Array, largest: float) -> Array:
    """Height (legs,), m, up to which every foot can be lifted from its stance, `largest` at most."""
    height = np.zeros(model.leg_count)
    _rise(
        model.dh,
        model.limits_less(LIMIT_MARGIN),
        model.closed_form,
        model.hips,
        model.hip_axes,
        np.asarray(stance_in_body, dtype=np.float64),
        largest,
        model.standing,
        height,
    )
    return height


@kernel
def _fill(
    dh: Array, limits: Array, closed_form: int, hips: Array, hip_axes: Array, stance: Array, heights: Array,
    largest: float, standing: Array, radius: Array,
) -> None:  # fmt: skip
    begin, along = np.empty(3), np.zeros(3)
    for leg in range(hips.shape[0]):
        for layer in range(heights.size):
            begin[:] = stance[leg]
            begin[2] += heights[layer]
            for bearing in range(radius.shape[2]):
                angle = 2.0 * np.pi * bearing / radius.shape[2]
                along[0], along[1] = np.cos(angle), np.sin(angle)
                radius[leg, layer, bearing] = length_of_ray(
                    dh, limits, closed_form, hips[leg], hip_axes[leg], begin, along, largest, standing
                )


@kernel
def _rise(
    dh: Array, limits: Array, closed_form: int, hips: Array, hip_axes: Array, stance: Array, largest: float,
    standing: Array, height: Array,
) -> None:  # fmt: skip
    up = np.array([0.0, 0.0, 1.0])
    for leg in range(hips.shape[0]):
        height[leg] = length_of_ray(
            dh, limits, closed_form, hips[leg], hip_axes[leg], stance[leg], up, largest, standing
        )


@kernel
def length_of_ray(
    dh: Array, limits: Array, closed_form: int, hip: Array, hip_axes: Array, begin: Array, along: Array,
    largest: float, standing: Array,
) -> float:  # fmt: skip
    """How far, m, a foot can move from `begin` (3,) in body `along` a direction (3,)."""
    joints, progress = standing.copy(), np.empty(3)
    ends = not begin_ray(dh, limits, closed_form, hip, hip_axes, begin, joints, progress)
    while not ends:
        ends = extend_ray(dh, limits, closed_form, hip, hip_axes, begin, along, largest, joints, progress)
    length: float = min(USED * progress[FAR], largest)
    return length


@kernel
def begin_ray(
    dh: Array, limits: Array, closed_form: int, hip: Array, hip_axes: Array, begin: Array, joints: Array,
    progress: Array,
) -> bool:  # fmt: skip
    """Reach for a ray's `begin` (3,) from a guess in `joints` (n,); False where that is beyond the leg's reach."""
    guess = joints.copy()
    progress[FAR], progress[STEP], progress[HALVED] = 0.0, RADIUS_STEP * np.abs(dh[:, 1:3]).sum(), 0.0
    return reaches(dh, limits, closed_form, hip, hip_axes, begin, FIRST_ITERATIONS, guess, joints)


@kernel
def extend_ray(
    dh: Array, limits: Array, closed_form: int, hip: Array, hip_axes: Array, begin: Array, along: Array,
    largest: float, joints: Array, progress: Array,
) -> bool:  # fmt: skip
    """Go on outwards until a place is not reached; returns whether the ray has come to its end."""
    foot, found = np.empty(3), np.empty(joints.size)
    while USED * progress[FAR] < largest:
        for k in range(3):
            foot[k] = begin[k] + (progress[FAR] + progress[STEP]) * along[k]
        reached = reaches(dh, limits, closed_form, hip, hip_axes, foot, ITERATIONS, joints, found)
        if not reached or turned(joints, found) > LARGEST_TURN:
            progress[STEP] *= 0.5
            progress[HALVED] += 1.0
            return bool(progress[HALVED] > HALVINGS)
        joints[:] = found
        progress[FAR] += progress[STEP]
    return True


@kernel
def reaches(
    dh: Array, limits: Array, closed_form: int, hip: Array, hip_axes: Array, foot: Array, iterations: int,
    guess: Array, joints: Array,
) -> bool:  # fmt: skip
    """Whether a leg reaches a `foot` (3,) in body; `joints` (n,) with which it does, found from a `guess` (n,)."""
    down = np.array([0.0, 0.0, -1.0])
    spare = REACHED * np.abs(dh[:, 1:3]).sum()
    return bool(
        solve_leg_to(dh, limits, closed_form, hip, hip_axes, foot, down, spare, iterations, guess, joints) <= spare
    )


@kernel
def turned(before: Array, after: Array) -> float:
    """Largest turn of a joint, rad."""
    most = 0.0
    for i in range(before.size):
        most = max(most, abs(after[i] - before[i]))
    return most
