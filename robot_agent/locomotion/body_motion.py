"""How the body moves over its feet in a tick: the walking velocity and what height, attitude and inclination need."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.ground_plane import fit_plane
from robot_agent.locomotion.posture import attitude_rate, height_rate, support_shift, wanted_up
from weaver_shared.config.locomotion import PostureConfig

Array = NDArray[np.float64]


class BodyMotion:
    """Twist of the body over the ground, split into walking and posture; `shift` moves the middle of the stance."""

    def __init__(self, config: PostureConfig, foot_depth: float, dt: float) -> None:
        self._config = config
        self._foot_depth = foot_depth
        self._dt = dt
        self._blend = 1.0 - float(np.exp(-dt / config.plane_time))
        self._fresh = np.zeros(3)
        self._wanted_up = np.zeros(3)
        self._rate = np.zeros(2)
        self._wanted_shift = np.zeros(2)
        self.plane = np.array([0.0, 0.0, -foot_depth])  # z = a x + b y + c in body, low-passed
        self.residual = 0.0  # m rms of the feet about it
        self.shift = np.zeros(2)
        self.linear = np.zeros(3)  # of posture alone, m/s in body
        self.angular = np.zeros(3)  # of posture alone, rad/s in body

    def begin(self, plane: Array) -> None:
        self.plane[:] = plane
        self.shift[:] = 0.0

    def update(self, anchors: Array, weight: Array, up: Array, centre_of_mass: Array) -> None:
        """Posture twist from where the feet stand, (legs, 3) in body, each with a `weight` (legs,)."""
        config, dt = self._config, self._dt
        self._fresh[:] = self.plane
        self.residual = fit_plane(anchors, weight, self._fresh)
        self.plane += self._blend * (self._fresh - self.plane)
        wanted_up(up, self.plane, config.follow_ground, self._wanted_up)
        attitude_rate(
            self._wanted_up, config.attitude_gain, config.attitude_rate, config.attitude_dead_band, self._rate
        )
        self.angular[0], self.angular[1] = self._rate
        rise = height_rate(
            self.plane, self._foot_depth, config.height_gain, config.height_rate, config.height_dead_band
        )
        support_shift(
            up, self._foot_depth + centre_of_mass[2], config.shift_fraction, config.largest_shift, self._wanted_shift
        )
        step = config.shift_rate * dt
        change = np.clip(self._wanted_shift - self.shift, -step, step)
        self.shift += change
        self.linear[0], self.linear[1] = -change / dt
        self.linear[2] = rise

    def climb(self, velocity: Array) -> float:
        """Speed along z of body, m/s, that keeps `velocity` (vx, vy, turn) parallel to the ground."""
        return float(self.plane[0] * velocity[0] + self.plane[1] * velocity[1])
