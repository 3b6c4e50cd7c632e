"""All legs' impedance: how far each foot gives way to the force it feels beyond its share of the weight (eq. 6)."""

from math import sqrt

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.admittance import step_admittance, transition
from robot_agent.locomotion.feet import STAND
from robot_agent.locomotion.walk_state import Record


@kernel
def give_way(walk: Record) -> None:
    """One tick of every leg's offset along gravity under the force it feels less the force expected."""
    legs, load, config = walk.model.legs, walk.load, walk.settings.admittance
    stiffness = walk.gait.stiffness
    if stiffness != load.stiffness:
        damping = damping_of(config.virtual_mass, config.damping_ratio, stiffness, config.smallest_damping)
        transition(config.virtual_mass, damping, stiffness, walk.model.dt, load.step)
        load.stiffness = stiffness
    for leg in range(legs):
        standing = walk.feet.mode[leg] == STAND
        load.surplus[leg] = walk.senses.force[leg] - load.load[leg] if standing else 0.0
    step_admittance(load.offset[:legs], load.surplus[:legs], load.step, config.largest_force, config.largest_offset)


@kernel
def damping_of(mass: float, ratio: float, stiffness: float, smallest: float) -> float:
    """N s/m: the asked ratio of critical damping, but never less than the closed loop needs."""
    return max(2.0 * ratio * sqrt(mass * stiffness), smallest)
