"""The rotation group inside kernels: exponential, logarithm and right Jacobian (Forster et al. 2017, eqs. 3-8)."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled

Array = NDArray[np.float64]


@compiled
def cross_matrix(v: Array) -> Array:
    m = np.zeros((3, 3))
    m[0, 1], m[0, 2], m[1, 2] = -v[2], v[1], -v[0]
    m[1, 0], m[2, 0], m[2, 1] = v[2], -v[1], v[0]
    return m


@compiled
def exponential(v: Array) -> Array:
    """Rotation matrix of the rotation vector `v` (rad)."""
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if squared < 1e-12:
        a, b = 1.0 - squared / 6.0, 0.5 - squared / 24.0
    else:
        angle = np.sqrt(squared)
        a, b = np.sin(angle) / angle, (1.0 - np.cos(angle)) / squared
    return _series(v, 1.0 - b * squared, a, b)


@compiled
def right_jacobian(v: Array) -> Array:
    """J with exp(v + d) = exp(v) exp(J d) to first order."""
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if squared < 1e-8:
        a, b = 0.5 - squared / 24.0, 1.0 / 6.0 - squared / 120.0
    else:
        angle = np.sqrt(squared)
        a, b = (1.0 - np.cos(angle)) / squared, (angle - np.sin(angle)) / (squared * angle)
    return _series(v, 1.0 - b * squared, -a, b)


@compiled
def inverse_right_jacobian(v: Array) -> Array:
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if squared < 1e-8:
        b = 1.0 / 12.0 + squared / 720.0
    else:
        angle = np.sqrt(squared)
        b = 1.0 / squared - (1.0 + np.cos(angle)) / (2.0 * angle * np.sin(angle))
    return _series(v, 1.0 - b * squared, 0.5, b)


@compiled
def logarithm(m: Array) -> Array:
    """Rotation vector (rad) of a rotation matrix; exact up to half a turn, where the axis comes from the diagonal."""
    v = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    cosine = min(1.0, max(-1.0, 0.5 * (m[0, 0] + m[1, 1] + m[2, 2] - 1.0)))
    sine = 0.5 * np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    angle = np.arctan2(sine, cosine)
    if sine > 1e-6:
        turned: Array = v * (0.5 * angle / sine)
        return turned
    if cosine > 0.0:
        return 0.5 * v
    k = 0
    for i in range(1, 3):
        if m[i, i] > m[k, k]:
            k = i
    axis = 0.5 * (m[:, k] + m[k, :])
    axis[k] += 1.0
    half_turn: Array = axis * (angle / np.sqrt(np.sum(axis * axis)))
    return half_turn


@compiled
def _series(v: Array, diagonal: float, first: float, second: float) -> Array:
    """diagonal I + first [v] + second v v^T."""
    m = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            m[i, j] = second * v[i] * v[j]
        m[i, i] += diagonal
    m[0, 1] -= first * v[2]
    m[0, 2] += first * v[1]
    m[1, 0] += first * v[2]
    m[1, 2] -= first * v[0]
    m[2, 0] -= first * v[1]
    m[2, 1] += first * v[0]
    return m


@compiled
def orthonormal(m: Array) -> Array:
    """The rotation next to `m`, one Newton step of the polar decomposition: undoes the rounding of many products."""
    return 1.5 * m - 0.5 * m @ (np.ascontiguousarray(m.T) @ m)
