"""From body velocity to a foot's path over one stride (ICRA'17 III-C; OpenSHC'20 eq. 16 and three Bezier curves).

Two curves make the swing: from lift-off to the apex and from the apex to the foothold, joined with one velocity. The
third, the stance, has equally spaced nodes: a foot on the ground moves at exactly the body's velocity, backwards, so
the walker integrates it directly.
"""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.bezier import quartic

Array = NDArray[np.float64]


@kernel
def foot_velocity(velocity: Array, foot_in_body: Array, result: Array) -> None:
    """Velocity (3,) in body of a foot fixed to the ground while the body moves with `velocity` (vx, vy, turn)."""
    result[0] = -velocity[0] + velocity[2] * foot_in_body[1]
    result[1] = -velocity[1] - velocity[2] * foot_in_body[0]
    result[2] = 0.0


@kernel
def stride_of(velocity: Array, foot_in_body: Array, duty: float, frequency: float, stride: Array) -> None:
    """Way (3,) in body that the body covers over one foot in one stance: v * duty / f (eq. 16)."""
    foot_velocity(velocity, foot_in_body, stride)
    for k in range(3):
        stride[k] *= -duty / frequency


@kernel
def swing_nodes(
    lift_off: Array,
    foothold: Array,
    up: Array,
    height: float,
    ground_velocity: Array,
    touchdown_speed: float,
    half_time: float,
    along_up: bool,
    outward: Array,
    first: Array,
    second: Array,
) -> None:
    """Nodes of both swing curves, (5, 3) each, in body.

    The apex lies half-way, `height` along `up` above the higher end. The foot leaves and meets the ground at the
    ground's own velocity (3,) seen from the body, and meets it sinking at `touchdown_speed`. `half_time` s is the
    duration of one curve. The apex is shifted by `outward` (3,) m. `along_up`: the whole second curve comes down on the
    foothold along `up`, as seen from the ground.
    """
    rise = 0.0
    for k in range(3):
        rise += (foothold[k] - lift_off[k]) * up[k]
    apex_over_lift_off = max(rise, 0.0) + height
    for k in range(3):
        leaving = 0.25 * half_time * ground_velocity[k]
        arriving = leaving - 0.25 * half_time * touchdown_speed * up[k]
        way = foothold[k] - lift_off[k] - rise * up[k]
        across = way - 4.0 * leaving if along_up else 0.5 * way
        apex = lift_off[k] + across + apex_over_lift_off * up[k]
        first[0, k] = lift_off[k]
        first[1, k] = lift_off[k] + leaving
        first[2, k] = lift_off[k] + 2.0 * leaving
        first[4, k] = apex
        second[0, k] = apex
        second[4, k] = foothold[k]
        second[3, k] = foothold[k] - arriving
        second[2, k] = foothold[k] - 2.0 * arriving
    for k in range(3):
        if along_up:
            first[3, k] = first[4, k] - 0.25 * half_time * ground_velocity[k]
        else:
            first[3, k] = 0.5 * (first[4, k] + first[2, k])
    # The node before the apex is as high as the apex: the foot passes it level, so the apex is the highest point.
    low = 0.0
    for k in range(3):
        low += (first[4, k] - first[3, k]) * up[k]
    for k in range(3):
        first[3, k] += low * up[k] + outward[k]
        first[4, k] += outward[k]
        second[0, k] += outward[k]
        second[1, k] = 2.0 * second[0, k] - first[3, k]


@kernel
def swing_point(progress: float, first: Array, second: Array, point: Array) -> None:
    """Fill `point` (3,) at `progress` 0..1 of the swing."""
    if progress < 0.5:
        quartic(first, 2.0 * progress, point)
    else:
        quartic(second, 2.0 * progress - 1.0, point)
