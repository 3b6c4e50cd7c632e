"""How the weight is shared among the feet, and how far each gives way to the force it feels beyond its share."""

import numpy as np

from numpy_tick.margins import beside
from robot_agent.locomotion.load import SMALLEST_SHARE

STAND, SWING, REACH = range(3)


def carry_load(walk):
    ease_share(walk)
    load, senses = walk.load, walk.senses
    load.load = share_load(
        beside(walk.feet.place, senses.unposed_centre, senses.unposed_up), load.share, walk.model.weight
    )


def ease_share(walk):
    feet, gait, load = walk.feet, walk.gait, walk.load
    load_time = walk.settings.foothold.load_time
    wanted = np.where(feet.mode == STAND, 1.0, 0.0)
    if gait.walking and not gait.halted:
        left = np.maximum((1.0 - gait.leg_phase) / gait.frequency / load_time, SMALLEST_SHARE)
        wanted = np.where(feet.lifted == 0, np.minimum(wanted, left), wanted)
    step = walk.model.dt / load_time
    eased = load.share + np.clip(wanted - load.share, -step, step)
    load.share = np.where(np.isin(feet.mode, (SWING, REACH)), 0.0, eased)


def share_load(points, share, weight):
    """Loads share * (f + g . p) in balance with the weight; `points` (legs, 2) are seen from the centre of mass."""
    total = share.sum()
    if total < 1e-6:
        return np.zeros(len(points))
    lever = np.column_stack([np.ones(len(points)), points])
    normal = (lever * share[:, None]).T @ lever + 1e-5 * total * np.diag([0.0, 1.0, 1.0])
    size = np.trace(normal)
    if abs(np.linalg.det(normal)) > 1e-12 * size**3:
        factor = np.linalg.solve(normal, [weight, 0.0, 0.0])
    else:
        factor = np.array([weight / total, 0.0, 0.0])
    loads = np.maximum(share * (lever @ factor), 0.0)
    return loads * weight / loads.sum() if loads.sum() > 0.0 else loads


def give_way(walk):
    load, config = walk.load, walk.settings.admittance
    for leg in range(walk.model.legs):
        stiffness = walk.gait.stiffness
        if config.neighbour_stiffness > 1.0:
            stiffness *= 1.0 + (config.neighbour_stiffness - 1.0) * neighbours_lift(walk, leg)
        load.surplus[leg] = 0.0
        if walk.feet.mode[leg] == STAND:
            surplus = walk.senses.force[leg] - load.load[leg]
            load.surplus[leg] = np.sign(surplus) * max(abs(surplus) - config.dead_band, 0.0)
        damping = max(2.0 * config.damping_ratio * np.sqrt(config.virtual_mass * stiffness), config.smallest_damping)
        load.stiffness[leg] = stiffness
        load.step[leg] = transition(config.virtual_mass, damping, stiffness, walk.model.dt)
        felt = np.clip(load.surplus[leg], -config.largest_force, config.largest_force)
        offset, rate = load.step[leg] @ [*load.offset[leg], felt]
        held = abs(offset) > config.largest_offset
        load.offset[leg] = (np.sign(offset) * config.largest_offset, 0.0) if held else (offset, rate)


def neighbours_lift(walk, leg):
    feet, legs, lift = walk.feet, walk.model.legs, [0.0]
    for other in ((leg + 1) % legs, (leg - 1) % legs):
        if feet.mode[other] == SWING:
            height = (feet.place[other] - feet.lift_off[other]) @ walk.senses.unposed_up
            lift.append(min(height / feet.swing_height[other], 1.0))
    return max(lift)


def transition(mass, damping, stiffness, dt):
    """(2, 3): exp of the system matrix with the force as a third, constant state, by its series."""
    system = np.array([[0.0, 1.0, 0.0], [-stiffness / mass, -damping / mass, 1.0 / mass], [0.0, 0.0, 0.0]]) * dt
    halvings = 12
    term = result = np.eye(3)
    for k in range(1, 12):
        term = term @ system / (k * 2.0**halvings)
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return result[:2]
