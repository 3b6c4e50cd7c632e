"""From the feet's places to the servos: inverse kinematics, speed limits, servo lead."""

import numpy as np

from numpy_tick.inverse import solve_leg
from numpy_tick.servo_pace import learn_demand
from robot_agent.locomotion import reasons

STAND = 0


def place_feet(walk):
    given = walk.feet.place + np.outer(walk.load.offset[:, 0], walk.senses.unposed_up)
    walk.joint.foot = (given - walk.orders.posing_position) @ walk.orders.posing_rotation


def reach_feet(walk):
    model, joint = walk.model, walk.joint
    for leg in range(model.legs):
        joint.wanted[leg], joint.distance_left[leg] = solve_leg(
            model, model.hips[leg], model.hip_axes[leg], joint.foot[leg], last_link(walk, leg), joint.previous[leg]
        )


def last_link(walk, leg):
    """Along gravity, leaning after the foot, but not by more than a tangent of 0.4."""
    away = walk.joint.foot[leg, :2] - walk.model.stance[leg, :2]
    lean = walk.settings.last_link_lean * away
    size = np.linalg.norm(lean)
    return np.append(lean * min(1.0, 0.4 / max(size, 1e-12)), 0.0) - walk.senses.up


def follow_angles(walk):
    model, joint = walk.model, walk.joint
    step = joint.wanted - joint.previous
    demand = np.abs(step / (model.speed_limit * model.dt)).max(axis=1)
    if walk.gait.walking:
        learn_demand(walk, demand.max())
    if demand.max() >= 1.0 - 1e-9:
        walk.answer.reasons |= reasons.SERVO_SPEED
        factor = 1.0 / np.maximum(demand, 1.0)
        together = walk.feet.mode == STAND
        factor = np.where(together, min([1.0, *factor[together]]), factor)
        joint.wanted = np.where((factor < 1.0)[:, None], joint.previous + factor[:, None] * step, joint.wanted)
    target_servos(walk)


def target_servos(walk):
    model, senses, joint = walk.model, walk.senses, walk.joint
    value = joint.wanted
    if walk.settings.compensate_servos:
        carried = np.einsum("lki,k->li", senses.jacobian, senses.up) * walk.load.load[:, None]
        rate = (joint.wanted - joint.previous) / model.dt
        lead = (senses.own_torque - carried) / model.servo_stiffness + model.servo_lag * rate
        value = np.clip(value + lead, *model.limits.T)
    last = joint.target.reshape(value.shape)
    joint.target = np.clip(value, last - model.target_step, last + model.target_step).ravel()
