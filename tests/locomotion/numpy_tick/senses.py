"""Readings, frames, foot forces and contacts."""

import numpy as np

from robot_agent.kinematics.foot_force import DAMPING, GRAVITY
from robot_agent.locomotion import reasons


def sense(walk):
    readings, senses, shape = walk.readings, walk.senses, walk.senses.joint_position.shape
    for name, reason in (("joint_position", reasons.JOINT_ANGLE), ("joint_torque", reasons.JOINT_TORQUE)):
        new = getattr(readings, name).reshape(shape)
        good = np.isfinite(new)
        setattr(senses, name, np.where(good, new, getattr(senses, name)))
        if not good.all():
            walk.answer.reasons |= reason
    length = np.linalg.norm(readings.gravity)
    if np.isfinite(length) and length > 0.1 and -readings.gravity[2] > 0.3 * length:
        senses.up = -readings.gravity / length
    else:
        walk.answer.reasons |= reasons.GRAVITY
    measure(walk)
    feel_forces(walk)
    senses.contact_left = np.where(
        readings.contact != 0, walk.settings.foothold.contact_hold, np.maximum(senses.contact_left - walk.model.dt, 0.0)
    )
    senses.contact = senses.contact_left > 0.0


def measure(walk):
    model, senses, orders = walk.model, walk.senses, walk.orders
    for leg in range(model.legs):
        senses.origins[leg], senses.axes[leg] = frames(
            model.dh, model.hips[leg], model.hip_axes[leg], senses.joint_position[leg]
        )
    middles = 0.5 * (senses.origins[:, :-1] + senses.origins[:, 1:])
    moment = model.trunk_mass * model.trunk_centre + np.einsum("lik,i->k", middles, model.link_mass)
    senses.centre_of_mass = moment / (model.trunk_mass + model.legs * model.link_mass.sum())
    rotation, position = orders.posing_rotation, orders.posing_position
    senses.unposed_up = rotation @ senses.up
    senses.unposed_centre = rotation @ senses.centre_of_mass + position
    senses.unposed_feet = senses.origins[:, -1] @ rotation.T + position


def frames(dh, hip, hip_axes, angles):
    """Origins (n + 1, 3) and axes (n, 3) by products of Denavit-Hartenberg matrices."""
    axes_now, place = hip_axes.copy(), hip.copy()
    side = np.linalg.det(hip_axes)  # -1 on a mirrored leg
    origins, axes = [place], []
    for (theta, d, r, alpha), angle in zip(dh[:, :4], angles, strict=True):
        axes.append(side * axes_now[:, 2])
        c, s = np.cos(theta + angle), np.sin(theta + angle)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        tilt = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(alpha), -np.sin(alpha)], [0.0, np.sin(alpha), np.cos(alpha)]])
        place = place + axes_now @ (turn @ [r, 0.0, d])
        axes_now = axes_now @ turn @ tilt
        origins.append(place)
    return np.array(origins), np.array(axes)


def jacobian_of(origins, axes):
    """(3, n)."""
    return np.cross(axes, origins[-1] - origins[:-1]).T


def feel_forces(walk):
    model, senses = walk.model, walk.senses
    for leg in range(model.legs):
        origins, axes = senses.origins[leg], senses.axes[leg]
        jacobian = jacobian_of(origins, axes)
        weights = -GRAVITY * np.outer(model.link_mass, senses.up)  # (n, 3) N
        middles = 0.5 * (origins[:-1] + origins[1:])
        own = [
            -axes[i] @ np.cross(middles[i:] - origins[i], weights[i:]).sum(axis=0) for i in range(model.joints)
        ]  # fmt: skip
        senses.jacobian[leg], senses.own_torque[leg] = jacobian, own
        normal = jacobian @ jacobian.T + DAMPING * np.eye(3)
        force = -np.linalg.solve(normal, jacobian @ (senses.joint_torque[leg] - own))
        senses.force[leg] += model.force_blend * (force @ senses.up - senses.force[leg])
