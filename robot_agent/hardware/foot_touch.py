"""Which feet bear weight, told by the torques of their legs: Weaver's feet have no switches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel, foot_force, foot_jacobian, leg_frames, link_gravity_torque
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

TOUCH_FORCE = 0.06  # of the robot's weight; a leg of six carries 0.17 to 0.33, friction hides 0.02
RELEASE_FORCE = 0.03  # of the weight
SETTLING_TICKS = 2


class FootTouch:
    """A threshold with hysteresis on the vertical ground force, held until it has lasted."""

    def __init__(self, robot: RobotDescription) -> None:
        self._model = LegModel.of_robot(robot)
        legs, joints = self._model.leg_count, self._model.joints_per_leg
        weight = robot.mass * GRAVITY
        self._touch, self._release = TOUCH_FORCE * weight, RELEASE_FORCE * weight
        self._contact = np.zeros(legs, dtype=np.bool_)
        self._pending = np.zeros(legs, dtype=np.int64)
        self._origins, self._axes = np.zeros((joints + 1, 3)), np.zeros((joints, 3))
        self._jacobian, self._own, self._force = np.zeros((3, joints)), np.zeros(joints), np.zeros(3)

    def step(self, position: Array, torque: Array, up_in_body: Array) -> NDArray[np.bool_]:
        """Contact (legs,) of joint angles (joints,) rad and torques (joints,) N m; `up_in_body` is a unit vector."""
        model = self._model
        vertical = np.empty(model.leg_count)
        angles, torques = (values.reshape(model.leg_count, -1) for values in (position, torque))
        for leg in range(model.leg_count):
            leg_frames(model.dh, model.hips[leg], model.hip_axes[leg], angles[leg], self._origins, self._axes)
            foot_jacobian(self._origins, self._axes, self._jacobian)
            link_gravity_torque(self._origins, self._axes, model.link_mass, -up_in_body, self._own)
            foot_force(self._jacobian, torques[leg], self._own, self._force)
            vertical[leg] = self._force @ up_in_body
        differs = np.where(self._contact, vertical < self._release, vertical > self._touch)
        self._pending = np.where(differs, self._pending + 1, 0)
        changed = self._pending >= SETTLING_TICKS
        self._contact = self._contact ^ changed
        self._pending[changed] = 0
        return self._contact.copy()
