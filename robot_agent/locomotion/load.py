"""How the robot's weight is shared among its feet: the least forces in balance with gravity."""

import numpy as np

from robot_agent.kinematics import solve_symmetric
from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import REACH, STAND, SWING
from robot_agent.locomotion.walk_state import Array, Record

SMALLEST_SHARE = 0.05
"""Of a foot about to lift off, so that three feet always balance."""


@kernel
def share_load(feet_in_body: Array, centre_of_mass: Array, up: Array, share: Array, weight: float, load: Array) -> None:
    """Fill `load` (legs,) N along `up`: minimal sum of load^2 / share under balance of force and moments.

    `share` (legs,) 0..1 says how far a foot takes part, so loads change smoothly as feet come and go. Feet can not
    pull: negative loads become zero and the rest is scaled to the weight.
    """
    legs = feet_in_body.shape[0]
    normal, right, factor = np.zeros((3, 3)), np.zeros(3), np.zeros(3)
    right[0] = weight
    for leg in range(legs):
        x, y = _beside(feet_in_body[leg], centre_of_mass, up)
        w = share[leg]
        normal[0, 0] += w
        normal[0, 1] += w * x
        normal[0, 2] += w * y
        normal[1, 1] += w * x * x
        normal[1, 2] += w * x * y
        normal[2, 2] += w * y * y
    normal[1, 0], normal[2, 0], normal[2, 1] = normal[0, 1], normal[0, 2], normal[1, 2]
    total = normal[0, 0]
    if total < 1e-6:
        load[:] = 0.0
        return
    normal[1, 1] += 1e-5 * total
    normal[2, 2] += 1e-5 * total
    if not solve_symmetric(normal, right, factor):
        factor[0], factor[1], factor[2] = weight / total, 0.0, 0.0
    carried = 0.0
    for leg in range(legs):
        x, y = _beside(feet_in_body[leg], centre_of_mass, up)
        load[leg] = max(share[leg] * (factor[0] + factor[1] * x + factor[2] * y), 0.0)
        carried += load[leg]
    if carried > 0.0:
        for leg in range(legs):
            load[leg] *= weight / carried


@kernel
def carry_load(walk: Record) -> None:
    """Share the weight among the standing feet, easing it on after touch-down and off before lift-off."""
    legs, feet, load, senses = walk.model.legs, walk.feet, walk.load, walk.senses
    ease_share(walk)
    share_load(
        feet.place[:legs],
        senses.unposed_centre,
        senses.unposed_up,
        load.share[:legs],
        walk.model.weight,
        load.load[:legs],
    )


@kernel
def ease_share(walk: Record) -> None:
    """Move each foot's share of the weight: on over `load_time` after touch-down, off before lift-off."""
    feet, gait, share = walk.feet, walk.gait, walk.load.share
    load_time = walk.settings.foothold.load_time
    largest = walk.model.dt / load_time
    stride_time = 1.0 / gait.frequency
    lifting = gait.walking and not gait.halted
    for leg in range(walk.model.legs):
        if feet.mode[leg] == SWING or feet.mode[leg] == REACH:
            share[leg] = 0.0
            continue
        wanted = 1.0 if feet.mode[leg] == STAND else 0.0
        if lifting and not feet.lifted[leg]:
            wanted = min(wanted, max((1.0 - gait.leg_phase[leg]) * stride_time / load_time, SMALLEST_SHARE))
        share[leg] += min(max(wanted - share[leg], -largest), largest)


@kernel
def _beside(foot: Array, centre: Array, up: Array) -> tuple[float, float]:
    """Horizontal place of a foot against the centre of mass, seen along gravity."""
    height = (foot[2] - centre[2]) / up[2]
    return foot[0] - centre[0] - height * up[0], foot[1] - centre[1] - height * up[1]
