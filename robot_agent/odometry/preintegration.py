"""Inertial preintegration between two frames (Forster et al., T-RO 2017), for samples that are means over intervals.

Relative motion is kept in the first frame's IMU axes, without gravity, with its first-order dependence on the biases,
so that a bias correction needs no second integration. The half-interval rotation makes a turning sample exact to
second order.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.rotations import cross_matrix, exponential, orthonormal, right_jacobian

Array = NDArray[np.float64]

POSITION_FLOOR = 1e-6
"""m, velocity likewise in m/s: no integration is better than this; keeps short intervals invertible."""


class Preintegrations(NamedTuple):
    """Slot k leads from frame k - 1 to frame k."""

    duration: Array  # (slots,) s
    rotation: Array  # (slots, 3, 3) first_from_second
    velocity: Array  # (slots, 3)
    position: Array  # (slots, 3)
    rotation_by_gyro: Array  # (slots, 3, 3) derivative to the gyro bias
    velocity_by_gyro: Array
    velocity_by_accel: Array
    position_by_gyro: Array
    position_by_accel: Array
    covariance: Array  # (slots, 9, 9) of rotation, velocity, position
    information: Array  # (slots, 9, 9)
    gyro_bias: Array  # (slots, 3) the integration was done with
    accel_bias: Array  # (slots, 3)

    @staticmethod
    def of(slots: int) -> Preintegrations:
        def matrices() -> Array:
            return np.zeros((slots, 3, 3))

        def vectors() -> Array:
            return np.zeros((slots, 3))

        return Preintegrations(
            duration=np.zeros(slots),
            rotation=np.tile(np.eye(3), (slots, 1, 1)),
            velocity=vectors(),
            position=vectors(),
            rotation_by_gyro=matrices(),
            velocity_by_gyro=matrices(),
            velocity_by_accel=matrices(),
            position_by_gyro=matrices(),
            position_by_accel=matrices(),
            covariance=np.zeros((slots, 9, 9)),
            information=np.tile(np.eye(9), (slots, 1, 1)),
            gyro_bias=vectors(),
            accel_bias=vectors(),
        )

    def remove(self, slot: int) -> None:
        for array in self:
            array[slot:-1] = array[slot + 1 :].copy()


@compiled
def begin(pre: Preintegrations, k: int, gyro_bias: Array, accel_bias: Array) -> None:
    """Empty slot k and fix the biases it is integrated with."""
    pre.duration[k] = 0.0
    pre.rotation[k] = np.eye(3)
    pre.velocity[k] = 0.0
    pre.position[k] = 0.0
    pre.rotation_by_gyro[k] = 0.0
    pre.velocity_by_gyro[k] = 0.0
    pre.velocity_by_accel[k] = 0.0
    pre.position_by_gyro[k] = 0.0
    pre.position_by_accel[k] = 0.0
    pre.covariance[k] = 0.0
    pre.gyro_bias[k] = gyro_bias
    pre.accel_bias[k] = accel_bias


@compiled
def integrate(pre: Preintegrations, k: int, samples: Array, gyro_density: float, accel_density: float) -> None:
    """Append `samples` (n, 7) of duration (s), angular velocity (rad/s) and specific force (m/s^2) to slot k."""
    propagation = np.eye(9)
    for i in range(samples.shape[0]):
        dt = samples[i, 0]
        turn = (samples[i, 1:4] - pre.gyro_bias[k]) * dt
        force = samples[i, 4:7] - pre.accel_bias[k]
        half = exponential(0.5 * turn)
        middle = pre.rotation[k] @ half
        increment = exponential(turn)
        jacobian = right_jacobian(turn)
        push = middle @ force
        swing = middle @ cross_matrix(force)
        undo = np.ascontiguousarray(increment.T)
        middle_by_gyro = np.ascontiguousarray(half.T) @ pre.rotation_by_gyro[k] - right_jacobian(0.5 * turn) * (
            0.5 * dt
        )
        bend = swing @ middle_by_gyro

        pre.position[k] += pre.velocity[k] * dt + push * (0.5 * dt * dt)
        pre.velocity[k] += push * dt
        pre.position_by_gyro[k] += pre.velocity_by_gyro[k] * dt - bend * (0.5 * dt * dt)
        pre.position_by_accel[k] += pre.velocity_by_accel[k] * dt - middle * (0.5 * dt * dt)
        pre.velocity_by_gyro[k] -= bend * dt
        pre.velocity_by_accel[k] -= middle * dt
        pre.rotation_by_gyro[k] = undo @ pre.rotation_by_gyro[k] - jacobian * dt
        pre.rotation[k] = pre.rotation[k] @ increment
        pre.duration[k] += dt

        propagation[:3, :3] = undo
        propagation[3:6, :3] = -swing * dt
        propagation[6:, :3] = -swing * (0.5 * dt * dt)
        for a in range(3):
            propagation[6 + a, 3 + a] = dt
        covariance = propagation @ pre.covariance[k] @ np.ascontiguousarray(propagation.T)
        for a in range(3):
            covariance[a, a] += gyro_density * gyro_density * dt
            covariance[3 + a, 3 + a] += accel_density * accel_density * dt
            covariance[6 + a, 6 + a] += accel_density * accel_density * dt * dt * dt / 3.0
            covariance[3 + a, 6 + a] += accel_density * accel_density * dt * dt / 2.0
            covariance[6 + a, 3 + a] += accel_density * accel_density * dt * dt / 2.0
        pre.covariance[k] = covariance
    pre.rotation[k] = orthonormal(pre.rotation[k])
    floored = pre.covariance[k].copy()
    for a in range(9):
        floored[a, a] += POSITION_FLOOR * POSITION_FLOOR
    pre.information[k] = np.linalg.inv(floored)


@compiled
def corrected(pre: Preintegrations, k: int, gyro_bias: Array, accel_bias: Array) -> tuple[Array, Array, Array]:
    """Rotation, velocity and position of slot k for these biases, to first order."""
    gyro = gyro_bias - pre.gyro_bias[k]
    accel = accel_bias - pre.accel_bias[k]
    return (
        pre.rotation[k] @ exponential(pre.rotation_by_gyro[k] @ gyro),
        pre.velocity[k] + pre.velocity_by_gyro[k] @ gyro + pre.velocity_by_accel[k] @ accel,
        pre.position[k] + pre.position_by_gyro[k] @ gyro + pre.position_by_accel[k] @ accel,
    )
