"""Landmarks tie the frames that see them; each is eliminated at once, by a Schur complement of rank three.

Poses are gathered in a small dense system of their own, six unknowns a frame, which stays in the processor's cache;
only its sum enters the window's, and with it the unknowns all frames have in common.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled, compiled_for_speed
from robot_agent.odometry.landmarks import Eyes, Landmarks
from robot_agent.odometry.reprojection_factor import (
    BEHIND,
    POSE,
    common_as_poses,
    exposure_views,
    mounted,
    observation_rows,
    whitened_error,
)
from robot_agent.odometry.window_state import COMMON, STATE, Frames

Array = NDArray[np.float64]

POINT, ERROR, WIDTH = 6, 9, 10
"""Columns of an observation's row: pose first, then point and error."""

ROUNDING = 1e-9
"""Share of a landmark's information added to its diagonal, so that a point seen along one ray can be eliminated."""


class Elimination(NamedTuple):
    """What is needed to get a landmark's own step back from that of the frames."""

    inverse: Array  # (rows, 3, 3) of the landmark's own block, zero where it has none
    gradient: Array  # (rows, 3)
    coupling: Array  # (rows, 3, POSE * slots) landmark to poses
    common: Array  # (POSE * slots, COMMON) poses' change by the common unknowns
    first: NDArray[np.int64]  # (rows,) first frame coupled
    end: NDArray[np.int64]  # (rows,) one beyond the last; 0 where the landmark ties nothing

    @staticmethod
    def of(rows: int, slots: int) -> Elimination:
        return Elimination(
            inverse=np.zeros((rows, 3, 3)),
            gradient=np.zeros((rows, 3)),
            coupling=np.zeros((rows, 3, POSE * slots)),
            common=np.zeros((POSE * slots, COMMON)),
            first=np.zeros(rows, dtype=np.int64),
            end=np.zeros(rows, dtype=np.int64),
        )


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
    trust: float,
    elimination: Elimination,
    hessian: Array,
    gradient: Array,
) -> float:
    """Add the `chosen` landmarks seen by two frames, already eliminated; errors at `frames`, Jacobians at `origin`.

    Beyond `huber` sigmas an observation counts less; all of them count `trust` times as much as their sigmas say.
    """
    poses = np.zeros((POSE * count, POSE * count))
    pull = np.zeros(POSE * count)
    rotation, _, _ = exposure_views(origin, eyes, count)
    common = common_as_poses(origin, rotation, count)
    elimination.common[: POSE * count] = common
    cost = _gather(frames, origin, landmarks, chosen, eyes, count, per_sigma, huber, trust, elimination, poses, pull)
    _scatter(poses, pull, common, count, hessian, gradient)
    return cost


@compiled_for_speed
def _gather(
    frames: Frames,
    origin: Frames,
    landmarks: Landmarks,
    chosen: NDArray[np.bool_],
    eyes: Eyes,
    count: int,
    per_sigma: float,
    huber: float,
    trust: float,
    elimination: Elimination,
    poses: Array,
    pull: Array,
) -> float:
    """Upper triangle and gradient of the poses' own system, all landmarks eliminated; returns the cost."""
    _, _, views = exposure_views(frames, eyes, count)
    rotation, position, linear = exposure_views(origin, eyes, count)
    seats = mounted(origin, eyes)
    rows = np.empty((4, WIDTH))
    own, own_pull = np.empty((3, 3)), np.empty(3)
    halves = np.empty((3, POSE * count))
    cost, root = 0.0, np.sqrt(trust)
    for row in range(landmarks.identity.shape[0]):
        elimination.end[row] = 0
        if not chosen[row] or not landmarks.solved[row]:
            continue
        first, end, number = _frames_seeing(landmarks.seen, row, count)
        if number < 2:
            continue
        coupling = elimination.coupling[row]
        coupling[:, POSE * first : POSE * end] = 0.0
        own[:] = 0.0
        own_pull[:] = 0.0
        for k in range(first, end):
            if not landmarks.seen[row, k]:
                continue
            rows[:] = 0.0
            for e in range(2):
                if not landmarks.seen[row, k] & (1 << e):
                    continue
                x, y = whitened_error(views, landmarks, row, k, e, per_sigma)
                if x >= BEHIND:  # has a weight of next to nothing, but a slope that throws the solution away
                    continue
                observation_rows(rotation, position, seats, linear, landmarks.point, row, k, e, rows)
                size = np.sqrt(x * x + y * y)
                cost += 0.5 * size * size if size <= huber else huber * (size - 0.5 * huber)
                weight = root if size <= huber else root * np.sqrt(huber / size)
                _weigh(rows, e, weight, x, y, per_sigma)
            _accumulate(rows, POSE * k, coupling, own, own_pull, poses, pull)
        if not _factorise(own, elimination.inverse, row):  # behind every eye that saw it: it says nothing
            continue
        elimination.first[row], elimination.end[row] = first, end
        elimination.gradient[row] = own_pull
        _eliminate(coupling, own, own_pull, POSE * first, POSE * end, halves, poses, pull)
    return cost * trust


@compiled_for_speed
def _frames_seeing(seen: NDArray[np.uint8], row: int, count: int) -> tuple[int, int, int]:
    """First frame that sees the landmark, one beyond the last, and how many do."""
    first, end, number = count, 0, 0
    for k in range(count):
        if seen[row, k]:
            first = min(first, k)
            end = k + 1
            number += 1
    return first, end, number


@compiled_for_speed
def _weigh(rows: Array, e: int, weight: float, x: float, y: float, per_sigma: float) -> None:
    """Add the error (x, y) to one eye's rows, and weigh them."""
    for n in range(2 * e, 2 * e + 2):
        for a in range(ERROR):
            rows[n, a] *= weight * per_sigma
        rows[n, ERROR] = weight * (x if n == 2 * e else y)


@compiled_for_speed
def _accumulate(
    rows: Array, base: int, coupling: Array, own: Array, own_pull: Array, poses: Array, pull: Array
) -> None:
    """Add one frame's normal equations: its pose at `base`, and the landmark's own block."""
    for a in range(POSE):
        a0, a1, a2, a3 = rows[0, a], rows[1, a], rows[2, a], rows[3, a]
        for b in range(a, POSE):
            poses[base + a, base + b] += a0 * rows[0, b] + a1 * rows[1, b] + a2 * rows[2, b] + a3 * rows[3, b]
        pull[base + a] += a0 * rows[0, ERROR] + a1 * rows[1, ERROR] + a2 * rows[2, ERROR] + a3 * rows[3, ERROR]
    for c in range(3):
        a0, a1, a2, a3 = rows[0, POINT + c], rows[1, POINT + c], rows[2, POINT + c], rows[3, POINT + c]
        for b in range(POSE):
            coupling[c, base + b] += a0 * rows[0, b] + a1 * rows[1, b] + a2 * rows[2, b] + a3 * rows[3, b]
        for b in range(3):
            n = POINT + b
            own[c, b] += a0 * rows[0, n] + a1 * rows[1, n] + a2 * rows[2, n] + a3 * rows[3, n]
        own_pull[c] += a0 * rows[0, ERROR] + a1 * rows[1, ERROR] + a2 * rows[2, ERROR] + a3 * rows[3, ERROR]


@compiled_for_speed
def _factorise(own: Array, inverse: Array, row: int) -> bool:
    """Replace `own` (3, 3) by its Cholesky factor with the reciprocal diagonal, and keep its inverse for later."""
    trace = own[0, 0] + own[1, 1] + own[2, 2]
    if not trace > 0.0:
        return False
    for a in range(3):
        own[a, a] += ROUNDING * trace
    d0 = 1.0 / np.sqrt(own[0, 0])
    l10, l20 = own[1, 0] * d0, own[2, 0] * d0
    d1 = 1.0 / np.sqrt(own[1, 1] - l10 * l10)
    l21 = (own[2, 1] - l20 * l10) * d1
    d2 = 1.0 / np.sqrt(own[2, 2] - l20 * l20 - l21 * l21)
    if not (d0 + d1 + d2 < np.inf):
        return False
    own[0, 0], own[1, 0], own[1, 1], own[2, 0], own[2, 1], own[2, 2] = d0, l10, d1, l20, l21, d2
    m10 = -l10 * d0 * d1
    m21 = -l21 * d1 * d2
    m20 = -(l20 * d0 + l21 * m10) * d2
    inverse[row, 0, 0] = d0 * d0 + m10 * m10 + m20 * m20
    inverse[row, 1, 1] = d1 * d1 + m21 * m21
    inverse[row, 2, 2] = d2 * d2
    inverse[row, 0, 1] = inverse[row, 1, 0] = m10 * d1 + m20 * m21
    inverse[row, 0, 2] = inverse[row, 2, 0] = m20 * d2
    inverse[row, 1, 2] = inverse[row, 2, 1] = m21 * d2
    return True


@compiled_for_speed
def _eliminate(
    coupling: Array,
    factor: Array,
    own_pull: Array,
    begin: int,
    end: int,
    halves: Array,
    poses: Array,
    pull: Array,
) -> None:
    """Take C^T (L L^T)^-1 C off the columns begin..end of the poses' system."""
    d0, d1, d2 = factor[0, 0], factor[1, 1], factor[2, 2]
    l10, l20, l21 = factor[1, 0], factor[2, 0], factor[2, 1]
    for a in range(begin, end):
        halves[0, a] = coupling[0, a] * d0
        halves[1, a] = (coupling[1, a] - l10 * halves[0, a]) * d1
        halves[2, a] = (coupling[2, a] - l20 * halves[0, a] - l21 * halves[1, a]) * d2
    p0 = own_pull[0] * d0
    p1 = (own_pull[1] - l10 * p0) * d1
    p2 = (own_pull[2] - l20 * p0 - l21 * p1) * d2
    for a in range(begin, end):
        a0, a1, a2 = halves[0, a], halves[1, a], halves[2, a]
        if a0 == 0.0 and a1 == 0.0 and a2 == 0.0:  # a frame in between that does not see it
            continue
        for b in range(a, end):
            poses[a, b] -= a0 * halves[0, b] + a1 * halves[1, b] + a2 * halves[2, b]
        pull[a] -= a0 * p0 + a1 * p1 + a2 * p2


@compiled
def _scatter(poses: Array, pull: Array, common: Array, count: int, hessian: Array, gradient: Array) -> None:
    """Add the poses' system to the window's; only the upper triangle is kept up."""
    for a in range(1, POSE * count):
        for b in range(a):
            poses[a, b] = poses[b, a]
    by_common = poses @ common
    both = np.ascontiguousarray(common.T) @ by_common
    last = STATE * count
    for i in range(count):
        for a in range(POSE):
            row, source = STATE * i + a, POSE * i + a
            for b in range(a, POSE):
                hessian[row, STATE * i + b] += poses[source, POSE * i + b]
            for k in range(i + 1, count):
                for b in range(POSE):
                    hessian[row, STATE * k + b] += poses[source, POSE * k + b]
            for b in range(COMMON):
                hessian[row, last + b] += by_common[source, b]
                gradient[last + b] += common[source, b] * pull[source]
            gradient[row] += pull[source]
    for a in range(COMMON):
        for b in range(a, COMMON):
            hessian[last + a, last + b] += both[a, b]


@compiled_for_speed
def move_points(landmarks: Landmarks, elimination: Elimination, count: int, step: Array) -> None:
    """Each eliminated landmark's own step, given that of the frames (unknowns,)."""
    pose_step = np.empty(POSE * count)
    for k in range(count):
        for a in range(POSE):
            row = POSE * k + a
            pose_step[row] = step[STATE * k + a]
            for b in range(COMMON):
                pose_step[row] += elimination.common[row, b] * step[STATE * count + b]
    pull = np.empty(3)
    for row in range(landmarks.identity.shape[0]):
        if elimination.end[row] == 0:
            continue
        for c in range(3):
            total = elimination.gradient[row, c]
            for n in range(POSE * elimination.first[row], POSE * elimination.end[row]):
                total += elimination.coupling[row, c, n] * pose_step[n]
            pull[c] = total
        for a in range(3):
            for b in range(3):
                landmarks.point[row, a] -= elimination.inverse[row, a, b] * pull[b]
