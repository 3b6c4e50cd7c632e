"""Pose and velocity carried forward by inertial samples."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.rotations import exponential, orthonormal
from weaver_shared.frames import GRAVITY

Array = NDArray[np.float64]


@compiled
def propagate(
    rotation: Array, position: Array, velocity: Array, gyro_bias: Array, accel_bias: Array, samples: Array
) -> tuple[Array, Array, Array]:
    """world_from_imu (3, 3), position (3,) and velocity (3,) in world after `samples` (n, 7)."""
    r, p, v = rotation.copy(), position.copy(), velocity.copy()
    for i in range(samples.shape[0]):
        dt = samples[i, 0]
        turn = (samples[i, 1:4] - gyro_bias) * dt
        acceleration = r @ exponential(0.5 * turn) @ (samples[i, 4:7] - accel_bias)
        acceleration[2] -= GRAVITY
        p += v * dt + acceleration * (0.5 * dt * dt)
        v += acceleration * dt
        r = r @ exponential(turn)
    return orthonormal(r), p, v
