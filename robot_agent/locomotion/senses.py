"""The walker's picture of its legs: cleaned readings, frames, foot forces, contacts and centre of mass."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel, all_leg_frames, foot_forces
from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.stability import centre_of_mass
from robot_agent.locomotion.walk_tick import WalkInput
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]


class LegSenses:
    """Readings that are not finite are replaced by the last good ones, and said so in `complaints`."""

    def __init__(self, robot: RobotDescription, model: LegModel, config: LocomotionConfig, dt: float) -> None:
        legs, joints = model.leg_count, model.joints_per_leg
        self._model = model
        self._blend = 1.0 - float(np.exp(-dt / config.admittance.force_time))
        self._hold = config.foothold.contact_hold
        self._dt = dt
        self._trunk_mass = robot.body.mass
        self._trunk_centre = np.array(robot.body.centre_of_mass_in_body)
        self._raw_force = np.zeros((legs, 3))
        self._contact_left = np.zeros(legs)
        self.joint_position = np.zeros((legs, joints))
        self.joint_torque = np.zeros((legs, joints))
        self.origins = np.zeros((legs, joints + 1, 3))
        self.axes = np.zeros((legs, joints, 3))
        self.centre_of_mass = np.zeros(3)
        self.up = np.array([0.0, 0.0, 1.0])  # in body, against gravity
        self.force = np.zeros(legs)  # N along up, low-passed
        self.contact = np.zeros(legs, dtype=np.bool_)
        self.complaints: tuple[str, ...] = ()

    @property
    def feet(self) -> Array:
        """Measured foot centres in body, (legs, 3) m."""
        return self.origins[:, -1]

    def update(self, sensed: WalkInput) -> None:
        complaints = []
        shape = self.joint_position.shape
        if not _take(self.joint_position, np.asarray(sensed.joint_position, dtype=np.float64).reshape(shape)):
            complaints.append("a joint angle is missing")
        if not _take(self.joint_torque, np.asarray(sensed.joint_torque, dtype=np.float64).reshape(shape)):
            complaints.append("a joint torque is missing")
        if not _take_up(self.up, np.asarray(sensed.gravity_in_body, dtype=np.float64)):
            complaints.append("the direction of gravity is missing")
        self.complaints = tuple(complaints)
        self.measure()
        foot_forces(self.origins, self.axes, self._model.link_mass, -self.up, self.joint_torque, self._raw_force)
        _hold_contacts(
            self._raw_force,
            self.up,
            self._blend,
            np.asarray(sensed.foot_contact, dtype=np.bool_),
            self._hold,
            self._dt,
            self.force,
            self._contact_left,
            self.contact,
        )

    def stand(self, joint_position: Array) -> None:
        """Believe the joints at these angles, (legs, n), and every foot on the ground."""
        self.joint_position[:] = joint_position
        self._contact_left[:] = self._hold
        self.contact[:] = True
        self.measure()

    def measure(self) -> None:
        """Frames and centre of mass from the joint angles."""
        model = self._model
        all_leg_frames(model.dh, model.hips, model.hip_axes, self.joint_position, self.origins, self.axes)
        centre_of_mass(self.origins, model.link_mass, self._trunk_mass, self._trunk_centre, self.centre_of_mass)


@kernel
def _take(kept: Array, new: Array) -> bool:
    """Copy the finite values of `new` (legs, n); False if any was not finite."""
    complete = True
    for leg in range(kept.shape[0]):
        for i in range(kept.shape[1]):
            if np.isfinite(new[leg, i]):
                kept[leg, i] = new[leg, i]
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
def _hold_contacts(
    raw_force: Array,
    up: Array,
    blend: float,
    sensed: NDArray[np.bool_],
    hold: float,
    dt: float,
    force: Array,
    left: Array,
    contact: NDArray[np.bool_],
) -> None:
    for leg in range(force.size):
        vertical = raw_force[leg, 0] * up[0] + raw_force[leg, 1] * up[1] + raw_force[leg, 2] * up[2]
        force[leg] += blend * (vertical - force[leg])
        left[leg] = hold if sensed[leg] else max(left[leg] - dt, 0.0)
        contact[leg] = left[leg] > 0.0
