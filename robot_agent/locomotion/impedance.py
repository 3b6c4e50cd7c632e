"""All legs' impedance: how far each foot gives way to the force it feels beyond its share of the weight (eq. 6)."""

from math import sqrt

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.admittance import step_admittance, transition
from robot_agent.locomotion.feet import STAND, SWING
from robot_agent.locomotion.walk_state import Record


@kernel
def give_way(walk: Record) -> None:
    """One tick of every leg's offset along gravity under the force it feels less the force expected."""
    load, config, mass = walk.load, walk.settings.admittance, walk.settings.admittance.virtual_mass
    for leg in range(walk.model.legs):
        stiffness = walk.gait.stiffness
        if config.neighbour_stiffness > 1.0:
            stiffness *= 1.0 + (config.neighbour_stiffness - 1.0) * neighbours_lift(walk, leg)
        if stiffness != load.stiffness[leg]:
            damping = damping_of(mass, config.damping_ratio, stiffness, config.smallest_damping)
            transition(mass, damping, stiffness, walk.model.dt, load.step[leg])
            load.stiffness[leg] = stiffness
        load.surplus[leg] = 0.0
        if walk.feet.mode[leg] == STAND:
            load.surplus[leg] = beyond(walk.senses.force[leg] - load.load[leg], config.dead_band)
        one = slice(leg, leg + 1)
        step_admittance(
            load.offset[one], load.surplus[one], load.step[leg], config.largest_force, config.largest_offset
        )


@kernel
def neighbours_lift(walk: Record, leg: int) -> float:
    """0..1: how high the higher of the two feet next to a leg swings, over its swing height (OpenSHC'20 IV-D).

    The leg takes over what they carried; a stiffer one sinks less under it.
    """
    feet, legs, up = walk.feet, walk.model.legs, walk.senses.unposed_up
    highest = 0.0
    for other in ((leg + 1) % legs, (leg + legs - 1) % legs):
        if feet.mode[other] == SWING:
            height = 0.0
            for k in range(3):
                height += (feet.place[other, k] - feet.lift_off[other, k]) * up[k]
            highest = max(highest, min(height / feet.swing_height[other], 1.0))
    return highest


@kernel
def beyond(force: float, dead_band: float) -> float:
    """What of a force, N, lies beyond a dead band of +- `dead_band`."""
    return max(abs(force) - dead_band, 0.0) * (1.0 if force > 0.0 else -1.0)


@kernel
def damping_of(mass: float, ratio: float, stiffness: float, smallest: float) -> float:
    """N s/m: the asked ratio of critical damping, but never less than the closed loop needs."""
    return max(2.0 * ratio * sqrt(mass * stiffness), smallest)
