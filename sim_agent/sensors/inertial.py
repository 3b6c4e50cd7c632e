"""The IMU: means over each sampling interval, with the noise and drifting bias of its data sheet."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots.description import Imu

Array = NDArray[np.float64]

SETTLED_TIME = 1000.0
"""Seconds of bias drift that lie behind the first sample, so that a run does not begin with a perfect sensor."""


class InertialSensor:
    """Turns successive motion states of the IMU's point into samples.

    A sample is the mean specific force and rate over its interval, as an integrating sensor gives them: sampling
    the acceleration at points instead loses what feet do between them (1.4 m in 10 s of dead reckoning).
    """

    def __init__(self, imu: Imu, generator: np.random.Generator) -> None:
        self._imu = imu
        self._dt = 1.0 / imu.rate
        self._generator = generator
        self._bias = np.empty((2, 3))
        self._bias[0] = generator.standard_normal(3) * imu.gyro_random_walk * np.sqrt(SETTLED_TIME)
        self._bias[1] = generator.standard_normal(3) * imu.accel_random_walk * np.sqrt(SETTLED_TIME)
        root = np.sqrt(self._dt)
        self._walk = np.array([imu.gyro_random_walk, imu.accel_random_walk]) * root
        self._noise = np.array([imu.gyro_noise_density, imu.accel_noise_density]) / root
        self._rotation: Array | None = None
        self._velocity = np.zeros(3)
        self._stamps: list[int] = []
        self._samples: list[Array] = []

    def begin(self, world_from_imu: Array, velocity_in_world: Array) -> None:
        """The state from which the first interval counts: rotation (3, 3) and velocity (3,) of the IMU's point."""
        self._rotation, self._velocity = world_from_imu, velocity_in_world

    def sample(self, stamp_ns: int, world_from_imu: Array, velocity_in_world: Array) -> None:
        """End an interval at this state and keep its sample."""
        if self._rotation is None:
            raise RuntimeError("begin() gives the first interval its start")
        sample = np.empty((2, 3))
        interval_means(self._rotation, world_from_imu, self._velocity, velocity_in_world, self._dt, sample)
        self.begin(world_from_imu, velocity_in_world)
        disturb(sample, self._bias, self._generator.standard_normal((4, 3)), self._walk, self._noise)
        self._stamps.append(stamp_ns)
        self._samples.append(sample)

    def take(self) -> ImuBatch:
        """All samples since the last call."""
        if not self._stamps:
            return ImuBatch.empty()
        samples = np.array(self._samples)
        batch = ImuBatch(
            stamp_ns=np.array(self._stamps, dtype=np.int64),
            angular_velocity_in_imu=np.ascontiguousarray(samples[:, 0]),
            specific_force_in_imu=np.ascontiguousarray(samples[:, 1]),
        )
        self._stamps, self._samples = [], []
        return batch


@njit(cache=True)
def interval_means(
    before: Array, after: Array, velocity_before: Array, velocity_after: Array, dt: float, means: Array
) -> None:
    """Fill mean rate and specific force in the IMU's frame (2, 3) between two states (rotations (3, 3), m/s)."""
    acceleration = (velocity_after - velocity_before) / dt
    acceleration[2] += GRAVITY
    change = before.T @ after
    # Logarithm by the antisymmetric part: exact for the small turns of an interval, however small.
    axis = 0.5 * np.array([change[2, 1] - change[1, 2], change[0, 2] - change[2, 0], change[1, 0] - change[0, 1]])
    sine = np.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
    angle = np.arctan2(sine, 0.5 * (change[0, 0] + change[1, 1] + change[2, 2] - 1.0))
    turn = axis * (angle / sine) if sine > 0.0 else axis
    # The frame halfway through the turn sees the mean force: rotate by half the angle, backwards (Rodrigues).
    force = before.T @ acceleration
    if sine > 0.0:
        unit = axis / sine
        cosine, half_sine = np.cos(0.5 * angle), np.sin(0.5 * angle)
        along = unit[0] * force[0] + unit[1] * force[1] + unit[2] * force[2]
        across = np.array(
            [
                unit[1] * force[2] - unit[2] * force[1],
                unit[2] * force[0] - unit[0] * force[2],
                unit[0] * force[1] - unit[1] * force[0],
            ]
        )
        force = cosine * force - half_sine * across + (1.0 - cosine) * along * unit
    means[0], means[1] = turn / dt, force


@njit(cache=True)
def disturb(sample: Array, bias: Array, normal: Array, walk: Array, noise: Array) -> None:
    """Let the biases (2, 3) drift and add them and white noise to a sample (2, 3); `normal` (4, 3) is standard."""
    for sensor in range(2):
        for axis in range(3):
            bias[sensor, axis] += walk[sensor] * normal[sensor, axis]
            sample[sensor, axis] += bias[sensor, axis] + noise[sensor] * normal[2 + sensor, axis]
