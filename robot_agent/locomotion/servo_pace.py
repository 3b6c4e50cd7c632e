"""The gait no faster than the servos: body and swinging feet slow down together, so that every foot stays on its path.

All feet move by the gait's pace, so joint speeds are in proportion to it, and the joint that needs most says how slow
it has to be. What the stride needs is remembered from the stride before, so that the robot walks evenly.
"""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.body_speed import speed_of
from robot_agent.locomotion.walk_state import PEAKS, Record

BLEND = 0.35
"""Of a tick's demand, in the low-pass on it: a single odd tick slows nothing."""
SLOWEST_PACE = 0.25
"""A foot that needs less lags behind for a moment."""
HARDEST = 8
"""Stretches of the stride, of `PEAKS`."""
LOW_PACE, GOOD_PACE = 0.75, 0.85
"""Paces under which strides get shorter, and over which they get longer again."""
FASTER = 1.1
"""Times, a stride."""
LEAST_SPEED = 0.5
"""Of the largest speed: shorter strides do not help feet that have to be lifted high."""


@kernel
def forget_demand(walk: Record) -> None:
    """Begin a walk with nothing known of what it needs."""
    gait = walk.gait
    gait.demand, gait.freshest_peak, gait.stretch = 0.0, 0.0, 0
    gait.peaks[:] = 0.0
    gait.stride_pace = 1.0
    gait.fastest = walk.settings.largest_speed


@kernel
def demanded_speed(walk: Record) -> float:
    """The joint speed that needs most of its limit, as a fraction of it, for the wanted angles of this tick."""
    model, joint, most = walk.model, walk.joint, 0.0
    for i in range(model.joints):
        fastest = model.speed_limit[i] * model.dt
        for leg in range(model.legs):
            most = max(most, abs(joint.wanted[leg, i] - joint.previous[leg, i]) / fastest)
    return most


@kernel
def learn_demand(walk: Record, demanded: float) -> None:
    """Remember what this tick needed, as it would be at full pace; of each stretch of the stride, the most."""
    gait = walk.gait
    gait.demand += BLEND * (demanded / max(gait.pace, SLOWEST_PACE) - gait.demand)
    stretch = min(int(gait.phase * PEAKS), PEAKS - 1)
    if stretch != gait.stretch:
        gait.peaks[gait.stretch] = gait.freshest_peak
        gait.stride_pace = pace_of_stride(walk)
        if stretch < gait.stretch and walk.settings.spare_servos:
            fit_speed(walk)
        gait.stretch, gait.freshest_peak = stretch, 0.0
    gait.freshest_peak = max(gait.freshest_peak, gait.demand)


@kernel
def fit_speed(walk: Record) -> None:
    """Once a stride: where the pace has to be low, walk with shorter strides, for stretched legs are slow ones."""
    gait, pace = walk.gait, walk.gait.stride_pace
    if pace < LOW_PACE:
        slower = 0.5 * (1.0 + pace / LOW_PACE) * speed_of(gait.commanded)
        gait.fastest = min(max(slower, LEAST_SPEED * walk.settings.largest_speed), gait.fastest)
    elif pace > GOOD_PACE:
        gait.fastest = min(FASTER * gait.fastest, walk.settings.largest_speed)


@kernel
def pace_of_moment(walk: Record) -> float:
    """The pace 0..1 at which no joint is too fast just now."""
    pace: float = max(1.0 / max(walk.gait.demand, 1.0), SLOWEST_PACE)
    return pace


@kernel
def pace_of_stride(walk: Record) -> float:
    """The pace 0..1 at which no joint was too fast in the last stride, but in its `HARDEST` stretches.

    In those slowing down for a moment costs less than a slow stride.
    """
    hardest = np.zeros(HARDEST + 1)
    for stretch in range(PEAKS):
        peak = walk.gait.peaks[stretch]
        for place in range(HARDEST + 1):
            if peak > hardest[place]:
                hardest[place], peak = peak, hardest[place]
    pace: float = max(1.0 / max(hardest[HARDEST], 1.0), SLOWEST_PACE)
    return pace
