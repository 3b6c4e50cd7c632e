"""A uniform B-spline of poses in time: rotations multiplied up, positions added up, with analytical derivatives.

Rotation after Sommer et al. 2020 (cumulative form on SO(3)): any turn is allowed, as no global chart is used.
Order 6, so that acceleration is smooth too.
"""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.compiled import compiled

Array = NDArray[np.float64]

ORDER = 6


@functools.cache
def blending() -> Array:
    """Matrix (6, 6) of cumulative weights: row j, times powers of the fraction u within a segment, gives lambda_j(u).

    Qin's closed form of the uniform basis, then sums over the control points from the j-th on.
    """
    k = ORDER
    basis = np.zeros((k, k))
    for s in range(k):
        for n in range(k):
            terms = [
                (-1.0) ** (term - s) * math.comb(k, term - s) * (k - 1 - term) ** (k - 1 - n) for term in range(s, k)
            ]
            basis[s, n] = math.comb(k - 1, n) / math.factorial(k - 1) * sum(terms)
    return np.cumsum(basis[::-1], axis=0)[::-1].copy()


@compiled
def weights(matrix: Array, fraction: float, interval: float, result: Array) -> None:
    """lambda (first row of `result` (3, 6)) and its first and second derivative by time."""
    result[:, :] = 0.0
    for j in range(matrix.shape[0]):
        power, first, second = 1.0, 1.0, 1.0
        for n in range(matrix.shape[1]):
            result[0, j] += matrix[j, n] * power
            power *= fraction
            if n >= 1:
                result[1, j] += n * matrix[j, n] * first / interval
                first *= fraction
            if n >= 2:
                result[2, j] += n * (n - 1) * matrix[j, n] * second / (interval * interval)
                second *= fraction


@compiled
def exponential(v: Array) -> Array:
    """Rotation matrix of a rotation vector (rad)."""
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if squared < 1e-10:
        return _series(v, 1.0 - squared / 6.0, 0.5 - squared / 24.0, 1.0 - (0.5 - squared / 24.0) * squared)
    angle = np.sqrt(squared)
    half = np.sin(0.5 * angle)
    b = 2.0 * half * half / squared
    return _series(v, np.sin(angle) / angle, b, 1.0 - b * squared)


@compiled
def right_jacobian(v: Array) -> Array:
    """J with exp(v + d) = exp(v) exp(J d) to first order."""
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    if squared < 1e-6:
        return _series(v, -0.5 + squared / 24.0, 1.0 / 6.0, 1.0 - squared / 6.0)
    angle = np.sqrt(squared)
    half = np.sin(0.5 * angle)
    c = (angle - np.sin(angle)) / (squared * angle)
    return _series(v, -2.0 * half * half / squared, c, 1.0 - c * squared)


@compiled
def inverse_right_jacobian(v: Array) -> Array:
    squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    c = 1.0 / 12.0 + squared / 720.0
    if squared > 1e-6:
        angle = np.sqrt(squared)
        c = 1.0 / squared - 0.5 / (angle * np.tan(0.5 * angle))
    return _series(v, 0.5, c, 1.0 - c * squared)


@compiled
def logarithm(m: Array) -> Array:
    """Rotation vector (rad) of a rotation matrix, less than half a turn."""
    v = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    sine = 0.5 * np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    angle = np.arctan2(sine, 0.5 * (m[0, 0] + m[1, 1] + m[2, 2] - 1.0))
    if sine < 1e-9:
        return 0.5 * v
    turned: Array = v * (0.5 * angle / sine)
    return turned


@compiled
def _series(v: Array, cross: float, outer: float, diagonal: float) -> Array:
    """diagonal I + cross [v] + outer v v^T."""
    m = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            m[i, j] = outer * v[i] * v[j]
        m[i, i] += diagonal
    m[0, 1] -= cross * v[2]
    m[0, 2] += cross * v[1]
    m[1, 0] += cross * v[2]
    m[1, 2] -= cross * v[0]
    m[2, 0] -= cross * v[1]
    m[2, 1] += cross * v[0]
    return m


@compiled
def cross_matrix(v: Array) -> Array:
    m = np.zeros((3, 3))
    m[0, 1], m[0, 2], m[1, 2] = -v[2], v[1], -v[0]
    m[1, 0], m[2, 0], m[2, 1] = v[2], -v[1], v[0]
    return m


@compiled
def rotation_at(rotations: Array, lambdas: Array, by_turn: Array, by_rate: Array) -> tuple[Array, Array]:
    """Rotation (3, 3) and angular velocity (3,) in the turned frame, of six control rotations (6, 3, 3).

    `by_turn` and `by_rate` (6, 3, 3) become the derivatives of both, the rotation's as a rotation vector multiplied on
    its right, by rotation vectors multiplied on the right of each control rotation.
    """
    order = rotations.shape[0]
    differences = np.empty((order, 3))
    steps = np.empty((order, 3, 3))
    rates = np.zeros((order, 3))
    turned = rotations[0].copy()
    for j in range(1, order):
        differences[j] = logarithm(np.ascontiguousarray(rotations[j - 1].T) @ rotations[j])
        steps[j] = exponential(lambdas[0, j] * differences[j])
        turned = turned @ steps[j]
        rates[j] = np.ascontiguousarray(steps[j].T) @ rates[j - 1] + lambdas[1, j] * differences[j]
    by_turn[:, :, :] = 0.0
    by_rate[:, :, :] = 0.0
    # What comes after step j turns its effect into the final frame.
    after = np.eye(3)
    for j in range(order - 1, 0, -1):
        eta = lambdas[0, j] * right_jacobian(lambdas[0, j] * differences[j])
        turn = after @ eta
        carried = rates[j] - lambdas[1, j] * differences[j]
        rate = after @ (cross_matrix(carried) @ eta + lambdas[1, j] * np.eye(3))
        inverse = inverse_right_jacobian(differences[j])
        transposed = np.ascontiguousarray(inverse.T)
        by_turn[j] += turn @ inverse
        by_turn[j - 1] -= turn @ transposed
        by_rate[j] += rate @ inverse
        by_rate[j - 1] -= rate @ transposed
        after = after @ np.ascontiguousarray(steps[j].T)
    by_turn[0] += after
    return turned, rates[order - 1]
