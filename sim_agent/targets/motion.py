"""How a person waves a rig before a target: turns about every axis, pushes along every axis, all smooth."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.target import AprilGrid
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose, rotation_exp, rotation_log

Array = NDArray[np.float64]

WAVES = 4
"""Per degree of freedom."""

FREQUENCIES = (0.1, 1.1)
"""Slowest and fastest wave, Hz."""

TILT, ROLL, ASIDE, NEARER = 0.40, 0.55, 0.16, 0.22
"""Amplitudes: about the picture's axes and about the line of sight (rad), across and along it (m)."""

_STEP = 2e-3
"""Of the differences that give velocities, s: their error is below 1e-9 of any sensor's."""


class HandHeldMotion:
    """The first eye's pose in the target's frame at any time, as sums of sines drawn by `generator`.

    `distance` (m) is the mean one to the target's middle; `axes` scales the six amplitudes, 0 for one kept still.
    """

    def __init__(
        self,
        grid: AprilGrid,
        distance: float,
        generator: np.random.Generator,
        axes: tuple[float, float, float, float, float, float] = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0),
    ) -> None:
        amplitudes = np.array([TILT, TILT, ROLL, ASIDE, ASIDE, NEARER]) * axes
        shares = generator.uniform(0.5, 1.0, (6, WAVES))
        self._amplitudes = amplitudes[:, None] * shares / shares.sum(axis=1, keepdims=True) * 1.4
        self._frequencies = 2.0 * np.pi * generator.uniform(*FREQUENCIES, (6, WAVES))
        self._phases = generator.uniform(0.0, 2.0 * np.pi, (6, WAVES))
        width, height = grid.size
        self._middle = np.array([0.5 * width, 0.5 * height, 0.0])
        self._distance = distance
        self._scale = distance / 0.55

    def target_from_camera(self, time: float) -> Pose:
        wave = (self._amplitudes * np.sin(self._frequencies * time + self._phases)).sum(axis=1)
        facing = np.diag([1.0, -1.0, -1.0])  # looking at the target, its y axis up in the picture
        rotation = facing @ rotation_exp([0.0, 0.0, wave[2]]) @ rotation_exp([wave[0], wave[1], 0.0])
        # Aims beside the middle: the target wanders over the picture.
        aside = np.array([self._scale * wave[3], self._scale * wave[4], 0.0])
        back = rotation @ np.array([0.0, 0.0, self._distance + self._scale * wave[5]])
        return Pose(rotation=rotation, position=self._middle + aside - back)


def inertia_along(
    motion: HandHeldMotion,
    camera_from_imu: Pose,
    times: Array,
    gravity_in_target: Array,
    imu: Imu,
    biases: Array,
    generator: np.random.Generator,
) -> ImuBatch:
    """Samples at `times` (n,) s, stamped with them, with the noise and wandering `biases` (2, 3) of the data sheet."""
    dt = 1.0 / imu.rate
    rates, forces = np.empty((len(times), 3)), np.empty((len(times), 3))
    for k, time in enumerate(times):
        before2, before, now, after, after2 = (
            motion.target_from_camera(float(time) + n * _STEP) @ camera_from_imu for n in (-2, -1, 0, 1, 2)
        )
        near = rotation_log(before.rotation.T @ after.rotation) / (2.0 * _STEP)
        far = rotation_log(before2.rotation.T @ after2.rotation) / (4.0 * _STEP)
        rates[k] = (4.0 * near - far) / 3.0
        acceleration = (
            -before2.position + 16.0 * before.position - 30.0 * now.position + 16.0 * after.position - after2.position
        ) / (12.0 * _STEP**2)
        forces[k] = now.rotation.T @ (acceleration - gravity_in_target)
    walk = np.cumsum(generator.standard_normal((2, len(times), 3)), axis=1) * np.sqrt(dt)
    noise = generator.standard_normal((2, len(times), 3)) / np.sqrt(dt)
    rates += biases[0] + imu.gyro_random_walk * walk[0] + imu.gyro_noise_density * noise[0]
    forces += biases[1] + imu.accel_random_walk * walk[1] + imu.accel_noise_density * noise[1]
    return ImuBatch(
        stamp_ns=np.rint(times * 1e9).astype(np.int64), angular_velocity_in_imu=rates, specific_force_in_imu=forces
    )


def gravity_before(tilt: Array) -> Array:
    """Gravity (3,) in the frame of a target that hangs on a wall, leaning by a rotation vector `tilt` (rad)."""
    return np.asarray(rotation_exp(tilt) @ np.array([0.0, -GRAVITY, 0.0]))
