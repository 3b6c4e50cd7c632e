"""The walker's picture of its legs: cleaned readings, frames, foot forces, contacts and centre of mass."""

import numpy as np

from robot_agent.kinematics import foot_force, foot_jacobian, leg_frames, link_gravity_torque, link_inertia_torque
from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.reasons import GRAVITY, JOINT_ANGLE, JOINT_TORQUE
from robot_agent.locomotion.stability import centre_of_mass
from robot_agent.locomotion.walk_state import Array, Record


@kernel
def sense(walk: Record) -> None:
    """Take this tick's readings. One that is not finite is replaced by the last good one, and named in the answer."""
    model, readings, senses = walk.model, walk.readings, walk.senses
    if not _take(senses.joint_position, readings.joint_position, model.legs, model.joints):
        walk.answer.reasons |= JOINT_ANGLE
    if not _take(senses.joint_torque, readings.joint_torque, model.legs, model.joints):
        walk.answer.reasons |= JOINT_TORQUE
    if not _take_up(senses.up, readings.gravity):
        walk.answer.reasons |= GRAVITY
    measure(walk)
    if walk.settings.foothold.contact_from_torque:
        _feel_inertia(walk)
    _feel_forces(walk)
    _hold_contacts(walk)


@kernel
def measure(walk: Record) -> None:
    """Frames and centre of mass from the joint angles, as seen in body and in the body without its posing."""
    model, senses, orders = walk.model, walk.senses, walk.orders
    legs, n = model.legs, model.joints
    dh = model.dh[:n]
    for leg in range(legs):
        leg_frames(
            dh,
            model.hips[leg],
            model.hip_axes[leg],
            senses.joint_position[leg],
            senses.origins[leg],
            senses.axes[leg],
        )
    centre_of_mass(
        senses.origins[:legs], model.link_mass[:n], model.trunk_mass, model.trunk_centre, senses.centre_of_mass
    )
    turn, shift = orders.posing_rotation, orders.posing_position
    for k in range(3):
        senses.unposed_up[k] = turn[k, 0] * senses.up[0] + turn[k, 1] * senses.up[1] + turn[k, 2] * senses.up[2]
    _unpose(turn, shift, senses.centre_of_mass, senses.unposed_centre)
    for leg in range(legs):
        _unpose(turn, shift, senses.origins[leg, n], senses.unposed_feet[leg])


@kernel
def _unpose(turn: Array, shift: Array, point: Array, result: Array) -> None:
    for k in range(3):
        result[k] = turn[k, 0] * point[0] + turn[k, 1] * point[1] + turn[k, 2] * point[2] + shift[k]


@kernel
def _take(kept: Array, new: Array, legs: int, joints: int) -> bool:
    """Copy the finite values of `new` (legs * n,) into `kept` (legs, n); False if any was not finite."""
    complete = True
    for leg in range(legs):
        for i in range(joints):
            value = new[leg * joints + i]
            if np.isfinite(value):
                kept[leg, i] = value
            else:
                complete = False
    return complete


@kernel
def _take_up(up: Array, gravity: Array) -> bool:
    """Up is against gravity; a vector without length, or one of a robot on its back, is not taken."""
    length = np.sqrt(gravity[0] ** 2 + gravity[1] ** 2 + gravity[2] ** 2)
    if not (np.isfinite(length) and length > 0.1 and -gravity[2] > 0.3 * length):
        return False
    for k in range(3):
        up[k] = -gravity[k] / length
    return True


@kernel
def _feel_forces(walk: Record) -> None:
    """Ground forces through each leg's Jacobian, low-passed along gravity; a leg's own weight is taken off."""
    model, senses = walk.model, walk.senses
    n, up = model.joints, senses.up
    down, force = np.empty(3), np.empty(3)
    for k in range(3):
        down[k] = -up[k]
    for leg in range(model.legs):
        origins, axes = senses.origins[leg, : n + 1], senses.axes[leg, :n]
        jacobian, own = senses.jacobian[leg], senses.own_torque[leg, :n]
        foot_jacobian(origins, axes, jacobian)
        link_gravity_torque(origins, axes, model.link_mass, down, own)
        if walk.settings.foothold.contact_from_torque:
            for i in range(n):
                own[i] += senses.inertia_torque[leg, i]
        foot_force(jacobian, senses.joint_torque[leg, :n], own, force)
        vertical = force[0] * up[0] + force[1] * up[1] + force[2] * up[2]
        senses.force[leg] += model.force_blend * (vertical - senses.force[leg])


@kernel
def _feel_inertia(walk: Record) -> None:
    """What moving the links takes, from the wanted rates: without it a fast leg in the air would seem to touch."""
    model, senses, joint = walk.model, walk.senses, walk.joint
    n, acceleration, torque = model.joints, np.empty(model.joints), np.empty(model.joints)
    for leg in range(model.legs):
        for i in range(n):
            rate = (joint.wanted[leg, i] - joint.previous[leg, i]) / model.dt
            acceleration[i] = (rate - senses.rate[leg, i]) / model.dt
            senses.rate[leg, i] = rate
        link_inertia_torque(senses.origins[leg, : n + 1], senses.axes[leg, :n], model.link_mass, acceleration, torque)
        for i in range(n):
            senses.inertia_torque[leg, i] += model.force_blend * (torque[i] - senses.inertia_torque[leg, i])


@kernel
def touching(walk: Record, leg: int) -> bool:
    """Whether a foot is on the ground: as sensed, or by its force, which has to fall lower than it rose to end that."""
    if not walk.settings.foothold.contact_from_torque:
        return bool(walk.readings.contact[leg])
    senses, foothold = walk.senses, walk.settings.foothold
    needed = foothold.liftoff_force if senses.pressing[leg] else foothold.touchdown_force
    senses.pressing[leg] = senses.force[leg] > needed
    return bool(senses.pressing[leg])


@kernel
def _hold_contacts(walk: Record) -> None:
    senses = walk.senses
    for leg in range(walk.model.legs):
        left = max(senses.contact_left[leg] - walk.model.dt, 0.0)
        senses.contact_left[leg] = walk.settings.foothold.contact_hold if touching(walk, leg) else left
        senses.contact[leg] = senses.contact_left[leg] > 0.0
