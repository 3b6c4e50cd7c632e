"""How the body moves over its feet in a tick: the walking velocity and what height, attitude and inclination need."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import HANG
from robot_agent.locomotion.ground_plane import fit_plane
from robot_agent.locomotion.posture import attitude_rate, height_rate, support_shift, wanted_up
from weaver_shared.config.locomotion import PostureConfig

Array = NDArray[np.float64]

HANGING_WEIGHT = 0.1


class BodyMotion:
    """Twist of the body over the ground; `shift` moves the middle of the stance against gravity's inclination."""

    def __init__(self, config: PostureConfig, foot_depth: float, dt: float) -> None:
        self._config = config
        self._foot_depth = foot_depth
        self._dt = dt
        self._blend = 1.0 - float(np.exp(-dt / config.plane_time))
        self._fresh = np.zeros(3)
        self._wanted_up = np.zeros(3)
        self._rate = np.zeros(2)
        self._wanted_shift = np.zeros(2)
        self._weight = np.zeros(0)
        self.plane = np.array([0.0, 0.0, -foot_depth])  # z = a x + b y + c in body, low-passed
        self.residual = 0.0  # m rms of the feet about it
        self.shift = np.zeros(2)
        self.linear = np.zeros(3)  # of posture alone, m/s in body
        self.angular = np.zeros(3)  # of posture alone, rad/s in body
        self.whole_linear = np.zeros(3)  # with the walking, parallel to the ground
        self.whole_angular = np.zeros(3)

    def begin(self, plane: Array) -> None:
        self.plane[:] = plane
        self.shift[:] = 0.0

    def update(
        self, anchors: Array, mode: NDArray[np.int64], up: Array, centre_of_mass: Array, velocity: Array
    ) -> None:
        """Twist from where the feet stand, (legs, 3) in body, and the walking `velocity` (vx, vy, turn)."""
        config = self._config
        if self._weight.size != mode.size:
            self._weight = np.ones(mode.size)
        self.residual = _follow_plane(anchors, mode, self._blend, self._weight, self._fresh, self.plane)
        wanted_up(up, self.plane, config.follow_ground, self._wanted_up)
        attitude_rate(
            self._wanted_up, config.attitude_gain, config.attitude_rate, config.attitude_dead_band, self._rate
        )
        rise = height_rate(
            self.plane, self._foot_depth, config.height_gain, config.height_rate, config.height_dead_band
        )
        support_shift(
            up, self._foot_depth + centre_of_mass[2], config.shift_fraction, config.largest_shift, self._wanted_shift
        )
        _compose(
            self.plane,
            velocity,
            self._rate,
            rise,
            self._wanted_shift,
            config.shift_rate,
            self._dt,
            self.shift,
            self.linear,
            self.angular,
            self.whole_linear,
            self.whole_angular,
        )


@kernel
def _follow_plane(
    anchors: Array, mode: NDArray[np.int64], blend: float, weight: Array, fresh: Array, plane: Array
) -> float:
    """Low-pass the plane through the feet; one that hangs over a hole hardly counts. Returns the residual, m rms."""
    for leg in range(mode.size):
        weight[leg] = HANGING_WEIGHT if mode[leg] == HANG else 1.0
    fresh[:] = plane
    residual = fit_plane(anchors, weight, fresh)
    for k in range(3):
        plane[k] += blend * (fresh[k] - plane[k])
    return residual


@kernel
def _compose(
    plane: Array,
    velocity: Array,
    attitude: Array,
    rise: float,
    wanted_shift: Array,
    shift_rate: float,
    dt: float,
    shift: Array,
    linear: Array,
    angular: Array,
    whole_linear: Array,
    whole_angular: Array,
) -> None:
    """Posture's twist, then posture and walking together: walking climbs with the ground's slope."""
    for k in range(2):
        change = min(max(wanted_shift[k] - shift[k], -shift_rate * dt), shift_rate * dt)
        shift[k] += change
        linear[k] = -change / dt
        angular[k] = attitude[k]
        whole_linear[k] = linear[k] + velocity[k]
        whole_angular[k] = angular[k]
    linear[2] = rise
    whole_linear[2] = rise + plane[0] * velocity[0] + plane[1] * velocity[1]
    whole_angular[2] = velocity[2]
