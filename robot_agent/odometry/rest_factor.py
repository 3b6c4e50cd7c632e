"""Standstill as a measurement: no velocity, and the pose of the frame before."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.rotations import inverse_right_jacobian, logarithm
from robot_agent.odometry.window_state import POSITION, ROTATION, STATE, VELOCITY, Frames

Array = NDArray[np.float64]


@compiled
def rest_residual(frames: Frames, k: int) -> Array:
    """Turn since frame k - 1 (in imu), way since then, velocity (in world), (9,)."""
    residual = np.empty(9)
    residual[:3] = logarithm(np.ascontiguousarray(frames.rotation[k - 1].T) @ frames.rotation[k])
    residual[3:6] = frames.position[k] - frames.position[k - 1]
    residual[6:] = frames.velocity[k]
    return residual


@compiled
def rest_jacobian(frames: Frames, k: int) -> Array:
    """Derivative (9, 30) to the states of frames k - 1 and k."""
    turn = np.ascontiguousarray(frames.rotation[k - 1].T) @ frames.rotation[k]
    unroll = inverse_right_jacobian(logarithm(turn))
    j = np.zeros((9, 2 * STATE))
    j[:3, ROTATION : ROTATION + 3] = -unroll @ np.ascontiguousarray(turn.T)
    j[:3, STATE + ROTATION : STATE + ROTATION + 3] = unroll
    for a in range(3):
        j[3 + a, POSITION + a] = -1.0
        j[3 + a, STATE + POSITION + a] = 1.0
        j[6 + a, STATE + VELOCITY + a] = 1.0
    return j


@compiled
def add_rest(
    frames: Frames,
    origin: Frames,
    resting: NDArray[np.bool_],
    first: int,
    last: int,
    sigmas: Array,
    hessian: Array,
    gradient: Array,
) -> float:
    """Add the factors of the resting intervals that end at frames first + 1 .. last; sigmas of the residual (9,)."""
    cost = 0.0
    for k in range(first + 1, last + 1):
        if not resting[k]:
            continue
        residual = rest_residual(frames, k) / sigmas
        jacobian = rest_jacobian(origin, k) / sigmas.reshape(9, 1)
        base = STATE * (k - 1)
        transposed = np.ascontiguousarray(jacobian.T)
        hessian[base : base + 2 * STATE, base : base + 2 * STATE] += transposed @ jacobian
        gradient[base : base + 2 * STATE] += transposed @ residual
        cost += 0.5 * float(residual @ residual)
    return cost
