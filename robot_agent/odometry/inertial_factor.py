"""Two frames tied by the inertia between them (Forster et al. 2017, eqs. 37-45) and by slowly walking biases."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.preintegration import Preintegrations, corrected
from robot_agent.odometry.rotations import (
    cross_matrix,
    exponential,
    inverse_right_jacobian,
    logarithm,
    right_jacobian,
)
from robot_agent.odometry.window_state import STATE, Frames
from weaver_shared.frames import GRAVITY

Array = NDArray[np.float64]

BIAS_RATE_FLOOR = 1e-6
"""rad/s and m/s^2: smallest walk of a bias between two frames."""


@compiled
def inertial_residual(frames: Frames, pre: Preintegrations, i: int, k: int) -> Array:
    """Rotation, velocity, position, gyro bias and accelerometer bias of frame k against frame i = k - 1, (15,)."""
    dt = pre.duration[k]
    rotation, velocity, position = corrected(pre, k, frames.gyro_bias[i], frames.accel_bias[i])
    imu_from_world = np.ascontiguousarray(frames.rotation[i].T)
    gained = frames.velocity[k] - frames.velocity[i]
    moved = frames.position[k] - frames.position[i] - frames.velocity[i] * dt
    gained[2] += GRAVITY * dt
    moved[2] += 0.5 * GRAVITY * dt * dt
    residual = np.empty(15)
    residual[:3] = logarithm(np.ascontiguousarray(rotation.T) @ (imu_from_world @ frames.rotation[k]))
    residual[3:6] = imu_from_world @ gained - velocity
    residual[6:9] = imu_from_world @ moved - position
    residual[9:12] = frames.gyro_bias[k] - frames.gyro_bias[i]
    residual[12:] = frames.accel_bias[k] - frames.accel_bias[i]
    return residual


@compiled
def inertial_jacobian(frames: Frames, pre: Preintegrations, i: int, k: int) -> Array:
    """Derivative (15, 30) of the residual to the states of frames i and k."""
    dt = pre.duration[k]
    rotation, _, _ = corrected(pre, k, frames.gyro_bias[i], frames.accel_bias[i])
    imu_from_world = np.ascontiguousarray(frames.rotation[i].T)
    gained = frames.velocity[k] - frames.velocity[i]
    moved = frames.position[k] - frames.position[i] - frames.velocity[i] * dt
    gained[2] += GRAVITY * dt
    moved[2] += 0.5 * GRAVITY * dt * dt
    first_from_second = imu_from_world @ frames.rotation[k]
    error = logarithm(np.ascontiguousarray(rotation.T) @ first_from_second)
    unroll = inverse_right_jacobian(error)
    gyro = frames.gyro_bias[i] - pre.gyro_bias[k]
    bent = right_jacobian(pre.rotation_by_gyro[k] @ gyro) @ pre.rotation_by_gyro[k]

    j = np.zeros((15, 30))
    j[:3, :3] = -unroll @ np.ascontiguousarray(first_from_second.T)
    j[:3, 9:12] = -unroll @ (np.ascontiguousarray(exponential(error).T) @ bent)
    j[:3, 15:18] = unroll
    j[3:6, :3] = cross_matrix(imu_from_world @ gained)
    j[3:6, 6:9] = -imu_from_world
    j[3:6, 9:12] = -pre.velocity_by_gyro[k]
    j[3:6, 12:15] = -pre.velocity_by_accel[k]
    j[3:6, 21:24] = imu_from_world
    j[6:9, :3] = cross_matrix(imu_from_world @ moved)
    j[6:9, 3:6] = -imu_from_world
    j[6:9, 6:9] = -imu_from_world * dt
    j[6:9, 9:12] = -pre.position_by_gyro[k]
    j[6:9, 12:15] = -pre.position_by_accel[k]
    j[6:9, 18:21] = imu_from_world
    for a in range(6):
        j[9 + a, 9 + a] = -1.0
        j[9 + a, 24 + a] = 1.0
    return j


@compiled
def add_inertia(
    frames: Frames,
    origin: Frames,
    pre: Preintegrations,
    first: int,
    last: int,
    bias_walk: Array,
    hessian: Array,
    gradient: Array,
) -> float:
    """Add the factors that end at frames first + 1 .. last; Jacobians at `origin`. Returns the cost."""
    cost = 0.0
    weight = np.zeros((15, 15))
    for k in range(first + 1, last + 1):
        weight[:9, :9] = pre.information[k]
        for a in range(3):
            weight[9 + a, 9 + a] = 1.0 / (bias_walk[0] ** 2 * pre.duration[k] + BIAS_RATE_FLOOR**2)
            weight[12 + a, 12 + a] = 1.0 / (bias_walk[1] ** 2 * pre.duration[k] + BIAS_RATE_FLOOR**2)
        residual = inertial_residual(frames, pre, k - 1, k)
        jacobian = inertial_jacobian(origin, pre, k - 1, k)
        weighted = np.ascontiguousarray(jacobian.T) @ weight
        begin = STATE * (k - 1)
        hessian[begin : begin + 30, begin : begin + 30] += weighted @ jacobian
        gradient[begin : begin + 30] += weighted @ residual
        cost += 0.5 * float(residual @ (weight @ residual))
    return cost
