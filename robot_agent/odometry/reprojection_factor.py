"""Landmarks tie the frames that see them: reprojection errors of both eyes, landmarks eliminated by Schur complement.

A picture is taken at its stamp plus the time offset, so each frame's pose is moved along its velocity and turn rate by
the offset before projecting; the offset thereby is an unknown like any other.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.landmarks import Eyes, Landmarks, Views, views_of
from robot_agent.odometry.rotations import exponential
from robot_agent.odometry.window_state import STATE, Frames

Array = NDArray[np.float64]


BEHIND = 1e6
"""sigmas: the error of a point that is not in front of the eye."""


class Elimination(NamedTuple):
    """What is needed to get a landmark's own step back from that of the frames."""

    inverse: Array  # (rows, 3, 3) of the landmark's own block
    gradient: Array  # (rows, 3)
    coupling: Array  # (rows, slots, 6, 3) pose to landmark
    offset_coupling: Array  # (rows, 3) time offset to landmark

    @staticmethod
    def of(rows: int, slots: int) -> Elimination:
        return Elimination(
            inverse=np.zeros((rows, 3, 3)),
            gradient=np.zeros((rows, 3)),
            coupling=np.zeros((rows, slots, 6, 3)),
            offset_coupling=np.zeros((rows, 3)),
        )


@compiled
def exposure_views(frames: Frames, eyes: Eyes, count: int) -> tuple[Array, Array, Views]:
    """Rotation and position of the IMU when each picture was taken, and both eyes' views from there."""
    dt = frames.time_offset[0]
    rotation = np.empty((count, 3, 3))
    position = np.empty((count, 3))
    for k in range(count):
        rotation[k] = frames.rotation[k] @ exponential(frames.rate[k] * dt)
        position[k] = frames.position[k] + frames.velocity[k] * dt
    return rotation, position, views_of(rotation, position, eyes, count)


@compiled
def whitened_error(
    views: Views, landmarks: Landmarks, row: int, k: int, e: int, per_sigma: float
) -> tuple[float, float]:
    """Projection less observation in sigmas; far beyond any gate when the point is not in front of the eye."""
    m = views.rotation[k, e]
    o = views.translation[k, e]
    p = landmarks.point[row]
    z = m[2, 0] * p[0] + m[2, 1] * p[1] + m[2, 2] * p[2] + o[2]
    if z < 0.05:
        return BEHIND, BEHIND
    x = (m[0, 0] * p[0] + m[0, 1] * p[1] + m[0, 2] * p[2] + o[0]) / z
    y = (m[1, 0] * p[0] + m[1, 1] * p[1] + m[1, 2] * p[2] + o[1]) / z
    observed = landmarks.observation[row, k, e]
    return (x - observed[0]) * per_sigma, (y - observed[1]) * per_sigma


@compiled
def observation_rows(
    rotation: Array,
    position: Array,
    eyes: Eyes,
    views: Views,
    point: Array,
    k: int,
    e: int,
    per_sigma: float,
    by_pose: Array,
    by_point: Array,
) -> None:
    """Fill the derivatives of one eye's error to its frame's pose (2, 6) and to the point (2, 3)."""
    m = views.rotation[k, e]
    o = views.translation[k, e]
    c = eyes.rotation[e]
    q = np.empty(3)
    d0, d1, d2 = point[0] - position[k, 0], point[1] - position[k, 1], point[2] - position[k, 2]
    for a in range(3):
        q[a] = rotation[k, 0, a] * d0 + rotation[k, 1, a] * d1 + rotation[k, 2, a] * d2
    z = max(0.05, m[2, 0] * point[0] + m[2, 1] * point[1] + m[2, 2] * point[2] + o[2])
    x = (m[0, 0] * point[0] + m[0, 1] * point[1] + m[0, 2] * point[2] + o[0]) / z
    y = (m[1, 0] * point[0] + m[1, 1] * point[1] + m[1, 2] * point[2] + o[1]) / z
    scale = per_sigma / z
    for a in range(3):
        by_point[0, a] = scale * (m[0, a] - x * m[2, a])
        by_point[1, a] = scale * (m[1, a] - y * m[2, a])
        by_pose[0, 3 + a] = -by_point[0, a]
        by_pose[1, 3 + a] = -by_point[1, a]
    for r in range(2):
        along = x if r == 0 else y
        g0 = scale * (c[r, 0] - along * c[2, 0])
        g1 = scale * (c[r, 1] - along * c[2, 1])
        g2 = scale * (c[r, 2] - along * c[2, 2])
        by_pose[r, 0] = g1 * q[2] - g2 * q[1]
        by_pose[r, 1] = g2 * q[0] - g0 * q[2]
        by_pose[r, 2] = g0 * q[1] - g1 * q[0]


@compiled
def add_reprojections(
    frames: Frames,
    origin: Frames,
    landmarks: Landmarks,
    chosen: NDArray[np.bool_],
    eyes: Eyes,
    count: int,
    per_sigma: float,
    huber: float,
    elimination: Elimination,
    hessian: Array,
    gradient: Array,
) -> float:
    """Add the `chosen` landmarks seen by two frames, already eliminated; errors at `frames`, Jacobians at `origin`."""
    _, _, views = exposure_views(frames, eyes, count)
    rotation, position, linear = exposure_views(origin, eyes, count)
    t = STATE * count
    by_pose = np.empty((2, 6))
    by_point = np.empty((2, 3))
    error = np.empty(2)
    motion = np.concatenate((origin.rate[:count], origin.velocity[:count]), axis=1)
    cost = 0.0
    seeing = np.empty(count, dtype=np.int64)
    for row in range(landmarks.identity.shape[0]):
        if not chosen[row] or not landmarks.solved[row]:
            continue
        number = _frames_seeing(landmarks, row, count, seeing)
        if number < 2:
            continue
        own = np.zeros((3, 3))
        own_gradient = np.zeros(3)
        offset = np.zeros(3)
        for n in range(number):
            k = seeing[n]
            coupling = elimination.coupling[row, k]
            coupling[:] = 0.0
            base = STATE * k
            for e in range(2):
                if not landmarks.seen[row, k] & (1 << e):
                    continue
                error[0], error[1] = whitened_error(views, landmarks, row, k, e, per_sigma)
                if error[0] >= BEHIND:  # has a weight of next to nothing, but a slope that throws the solution away
                    continue
                observation_rows(
                    rotation, position, eyes, linear, landmarks.point[row], k, e, per_sigma, by_pose, by_point
                )
                size = np.sqrt(error[0] * error[0] + error[1] * error[1])
                weight = 1.0 if size <= huber else huber / size
                cost += 0.5 * size * size if size <= huber else huber * (size - 0.5 * huber)
                _accumulate(
                    by_pose,
                    by_point,
                    error,
                    weight,
                    motion[k],
                    base,
                    t,
                    coupling,
                    own,
                    own_gradient,
                    offset,
                    hessian,
                    gradient,
                )
        trace = own[0, 0] + own[1, 1] + own[2, 2]
        if not trace > 0.0:  # behind every eye that saw it: it says nothing and stays where it is
            elimination.inverse[row] = 0.0
            elimination.gradient[row] = 0.0
            elimination.offset_coupling[row] = 0.0
            continue
        for a in range(3):
            own[a, a] += 1e-9 * trace
        elimination.inverse[row] = np.linalg.inv(own)
        elimination.gradient[row] = own_gradient
        elimination.offset_coupling[row] = offset
        _eliminate(elimination, row, seeing, number, t, hessian, gradient)
    return cost


@compiled
def _frames_seeing(landmarks: Landmarks, row: int, count: int, seeing: NDArray[np.int64]) -> int:
    number = 0
    for k in range(count):
        if landmarks.seen[row, k]:
            seeing[number] = k
            number += 1
    return number


@compiled
def _accumulate(
    by_pose: Array,
    by_point: Array,
    error: Array,
    weight: float,
    motion: Array,
    base: int,
    t: int,
    coupling: Array,
    own: Array,
    own_gradient: Array,
    offset: Array,
    hessian: Array,
    gradient: Array,
) -> None:
    """One eye's normal equations: pose at `base`, time offset at `t`, and the landmark's own block."""
    for r in range(2):
        by_offset = 0.0
        for a in range(6):
            by_offset += by_pose[r, a] * motion[a]
        w_error = weight * error[r]
        for a in range(6):
            wa = weight * by_pose[r, a]
            for b in range(a, 6):
                hessian[base + a, base + b] += wa * by_pose[r, b]
            for b in range(3):
                coupling[a, b] += wa * by_point[r, b]
            hessian[base + a, t] += wa * by_offset
            gradient[base + a] += by_pose[r, a] * w_error
        for a in range(3):
            wa = weight * by_point[r, a]
            for b in range(3):
                own[a, b] += wa * by_point[r, b]
            offset[a] += wa * by_offset
            own_gradient[a] += by_point[r, a] * w_error
        hessian[t, t] += weight * by_offset * by_offset
        gradient[t] += by_offset * w_error


@compiled
def _eliminate(
    elimination: Elimination,
    row: int,
    seeing: NDArray[np.int64],
    number: int,
    t: int,
    hessian: Array,
    gradient: Array,
) -> None:
    """Schur complement of one landmark; only the upper triangle of the Hessian is kept up."""
    inverse = elimination.inverse[row]
    own_gradient = elimination.gradient[row]
    offset = elimination.offset_coupling[row]
    part = np.empty((6, 3))
    for n in range(number):
        i = seeing[n]
        coupling = elimination.coupling[row, i]
        base = STATE * i
        for a in range(6):
            for b in range(3):
                part[a, b] = (
                    coupling[a, 0] * inverse[0, b] + coupling[a, 1] * inverse[1, b] + coupling[a, 2] * inverse[2, b]
                )
            gradient[base + a] -= (
                part[a, 0] * own_gradient[0] + part[a, 1] * own_gradient[1] + part[a, 2] * own_gradient[2]
            )
            hessian[base + a, t] -= part[a, 0] * offset[0] + part[a, 1] * offset[1] + part[a, 2] * offset[2]
        for other in range(n, number):
            k = seeing[other]
            far = elimination.coupling[row, k]
            column = STATE * k
            for a in range(6):
                for b in range(6):
                    hessian[base + a, column + b] -= (
                        part[a, 0] * far[b, 0] + part[a, 1] * far[b, 1] + part[a, 2] * far[b, 2]
                    )
    for a in range(3):
        pulled = offset[0] * inverse[0, a] + offset[1] * inverse[1, a] + offset[2] * inverse[2, a]
        hessian[t, t] -= pulled * offset[a]
        gradient[t] -= pulled * own_gradient[a]


@compiled
def move_points(
    landmarks: Landmarks, chosen: NDArray[np.bool_], elimination: Elimination, count: int, step: Array
) -> None:
    """Each landmark's own step, given that of the frames (unknowns,)."""
    pull = np.empty(3)
    for row in range(landmarks.identity.shape[0]):
        if not chosen[row] or not landmarks.solved[row]:
            continue
        number = 0
        for b in range(3):
            pull[b] = elimination.gradient[row, b] + elimination.offset_coupling[row, b] * step[STATE * count]
        for k in range(count):
            if landmarks.seen[row, k]:
                number += 1
                for a in range(6):
                    for b in range(3):
                        pull[b] += elimination.coupling[row, k, a, b] * step[STATE * k + a]
        if number >= 2:
            for a in range(3):
                for b in range(3):
                    landmarks.point[row, a] -= elimination.inverse[row, a, b] * pull[b]


@compiled
def reject(
    frames: Frames, landmarks: Landmarks, eyes: Eyes, count: int, per_sigma: float, gate: float
) -> NDArray[np.bool_]:
    """Unsee every observation beyond `gate` sigmas; True for the rows whose newest observation was among them."""
    _, _, views = exposure_views(frames, eyes, count)
    dead = np.zeros(landmarks.identity.shape[0], dtype=np.bool_)
    for row in range(landmarks.identity.shape[0]):
        if not landmarks.solved[row]:
            continue
        for k in range(count):
            for e in range(2):
                bit = 1 << e
                if not landmarks.seen[row, k] & bit:
                    continue
                ex, ey = whitened_error(views, landmarks, row, k, e, per_sigma)
                if not ex * ex + ey * ey <= gate * gate:
                    landmarks.seen[row, k] &= np.uint8(3 - bit)
                    if k == count - 1:
                        dead[row] = True
    return dead
