"""From the feet's places to the servos: inverse kinematics, speed limits, servo lead."""

import numpy as np

from numpy_tick.inverse import solve_leg
from robot_agent.locomotion import reasons
from robot_agent.locomotion.legs_tick import SLOWEST_PACE

STAND = 0


def place_feet(walk):
    given = walk.feet.place + np.outer(walk.load.offset[:, 0], walk.senses.unposed_up)
    walk.joint.foot = (given - walk.orders.posing_position) @ walk.orders.posing_rotation


def reach_feet(walk):
    model, joint = walk.model, walk.joint
    for leg in range(model.legs):
        joint.wanted[leg], joint.distance_left[leg] = solve_leg(
            model, model.hips[leg], model.hip_axes[leg], joint.foot[leg], -walk.senses.up, joint.previous[leg]
        )


def follow_angles(walk):
    model, joint = walk.model, walk.joint
    limit = model.speed_limit * model.dt
    step = joint.wanted - joint.previous
    factor = np.minimum(1.0, 1.0 / np.maximum(np.abs(step) / limit, 1e-300).max(axis=1))
    together = walk.feet.mode == STAND
    shared = min([1.0, *factor[together]])
    factor = np.where(together, shared, factor)
    joint.wanted = np.where((factor < 1.0)[:, None], joint.previous + factor[:, None] * step, joint.wanted)
    if shared < 1.0:
        walk.gait.pace = min(walk.gait.pace, max(shared, SLOWEST_PACE))
    if (np.abs(joint.wanted - joint.previous) > (1.0 - 1e-9) * limit).any():
        walk.answer.reasons |= reasons.SERVO_SPEED
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
