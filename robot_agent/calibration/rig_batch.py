"""Batch least squares over all views: lenses, the eyes' places and every pose of the target at once.

Levenberg-Marquardt with the views eliminated (Schur complement), robust by Huber's weights; corners that are wild in
the end are left out and the rest solved again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.corner_table import CornerTable
from robot_agent.calibration.rig import Rig, moved
from robot_agent.calibration.rig_kernels import normal_equations, residuals
from robot_agent.calibration.robust import WILD, huber_cost, huber_weights, sigma_of
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

Free = Literal["all", "places", "poses"]

MOST_STEPS = 60
ROUNDS = 4
"""Of weighting anew: after each the scale of the noise is known better."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigEstimate:
    rig: Rig
    first_from_target: tuple[Pose, ...]  # one per view
    table: CornerTable
    residuals: Array  # (n, 2) px, of all corners in `table`
    used: NDArray[np.bool_]  # (n,): not wild
    sigma: float  # px, of one coordinate
    covariance: Array  # (m, m) of the rig's parameters: 8 per eye, then 6 per eye but the first

    @property
    def rms(self) -> float:
        """Root mean square length of the residuals of all corners, as OpenCV reports it, px."""
        return float(np.sqrt((self.residuals**2).sum(axis=1).mean()))

    @property
    def intrinsics_sigma(self) -> Array:
        """(eyes, 8)"""
        return np.sqrt(np.diag(self.covariance)[: 8 * self.rig.eyes]).reshape(-1, 8)


def solve_rig(rig: Rig, poses: list[Pose], table: CornerTable, *, free: Free = "all") -> RigEstimate:
    """From a start near enough. `free` says what is unknown beside the poses of the target.

    Everything, only where the eyes stand ("places"), or nothing ("poses").
    """
    used = np.ones(len(table), dtype=np.bool_)
    for _ in range(ROUNDS):
        left = residuals(*_state(rig, poses), *_rows(table))
        sigma = sigma_of(left[used])
        rig, poses = _minimise(rig, poses, table.only(used), sigma, free)
        left = residuals(*_state(rig, poses), *_rows(table))
        sigma = sigma_of(left[used])
        used = np.linalg.norm(left, axis=1) < WILD * sigma
    covariance = _covariance(rig, poses, table.only(used), sigma, free)
    return RigEstimate(
        rig=rig,
        first_from_target=tuple(poses),
        table=table,
        residuals=left,
        used=used,
        sigma=sigma,
        covariance=covariance,
    )


def _minimise(rig: Rig, poses: list[Pose], table: CornerTable, sigma: float, free: Free) -> tuple[Rig, list[Pose]]:
    rows = _rows(table)
    damping = 1e-4
    left = residuals(*_state(rig, poses), *rows)
    cost = huber_cost(left, sigma)
    for _ in range(MOST_STEPS):
        blocks = normal_equations(*_state(rig, poses), *rows, huber_weights(left, sigma))
        while True:
            rig_step, view_steps = _step(blocks, damping, _fixed(rig, free))
            candidate, candidate_poses = _moved(rig, poses, rig_step, view_steps)
            left_then = residuals(*_state(candidate, candidate_poses), *rows)
            cost_then = huber_cost(left_then, sigma)
            if cost_then <= cost or damping > 1e8:
                break
            damping *= 10.0
        if cost_then > cost:
            break
        gain = cost - cost_then
        rig, poses, left, cost = candidate, candidate_poses, left_then, cost_then
        damping = max(damping * 0.1, 1e-12)
        if gain < 1e-9 * (cost + 1.0):
            break
    return rig, poses


def _step(
    blocks: tuple[Array, Array, Array, Array, Array], damping: float, fixed: NDArray[np.bool_]
) -> tuple[Array, Array]:
    by_view, across, by_rig, view_gradient, rig_gradient = blocks
    diagonal = np.einsum("vii->vi", by_view)
    damped = by_view + damping * np.eye(6) * np.maximum(diagonal, 1e-9)[:, None, :]
    solved = np.linalg.solve(damped, np.concatenate([across, view_gradient[:, :, None]], axis=2))
    reduced = by_rig - np.einsum("via,vib->ab", across, solved[:, :, :-1])
    gradient = rig_gradient - np.einsum("via,vi->a", across, solved[:, :, -1])
    reduced = reduced + damping * np.diag(np.maximum(np.diag(by_rig), 1e-9))
    step = np.zeros(len(gradient))
    free = np.flatnonzero(~fixed)
    if len(free):
        scale = 1.0 / np.sqrt(np.maximum(np.diag(reduced)[free], 1e-12))
        step[free] = -scale * np.linalg.solve(
            reduced[np.ix_(free, free)] * scale[:, None] * scale, gradient[free] * scale
        )
    views = -solved[:, :, -1] - solved[:, :, :-1] @ step
    return step, views


def _covariance(rig: Rig, poses: list[Pose], table: CornerTable, sigma: float, free: Free) -> Array:
    left = residuals(*_state(rig, poses), *_rows(table))
    by_view, across, by_rig, _, _ = normal_equations(*_state(rig, poses), *_rows(table), huber_weights(left, sigma))
    solved = np.linalg.solve(by_view + 1e-9 * np.eye(6), across)
    reduced = by_rig - np.einsum("via,vib->ab", across, solved)
    unknown = np.flatnonzero(~_fixed(rig, free))
    covariance = np.zeros_like(by_rig)
    if len(unknown):
        scale = 1.0 / np.sqrt(np.maximum(np.diag(reduced)[unknown], 1e-12))
        inverse = np.linalg.pinv(reduced[np.ix_(unknown, unknown)] * scale[:, None] * scale, hermitian=True)
        covariance[np.ix_(unknown, unknown)] = inverse * scale[:, None] * scale
    return covariance


def _fixed(rig: Rig, free: Free) -> NDArray[np.bool_]:
    """Parameters that stay: distortion of a lens without any, and what is known."""
    fixed = np.zeros(8 * rig.eyes + 6 * (rig.eyes - 1), dtype=np.bool_)
    for eye, model in enumerate(rig.models):
        fixed[8 * eye : 8 * eye + 8] = free != "all"
        if model == "none":
            fixed[8 * eye + 4 : 8 * eye + 8] = True
    fixed[8 * rig.eyes :] = free == "poses"
    return fixed


def _moved(rig: Rig, poses: list[Pose], rig_step: Array, view_steps: Array) -> tuple[Rig, list[Pose]]:
    eyes = rig.eyes
    places = rig_step[8 * eyes :].reshape(-1, 6)
    stepped = Rig(
        models=rig.models,
        intrinsics=rig.intrinsics + rig_step[: 8 * eyes].reshape(eyes, 8),
        eye_from_first=(
            rig.eye_from_first[0],
            *(moved(pose, step) for pose, step in zip(rig.eye_from_first[1:], places, strict=True)),
        ),
        sizes=rig.sizes,
    )
    return stepped, [moved(pose, step) for pose, step in zip(poses, view_steps, strict=True)]


def _state(rig: Rig, poses: list[Pose]) -> tuple[NDArray[np.int64], Array, Array, Array, Array, Array]:
    return (
        rig.model_numbers,
        rig.intrinsics,
        rig.rotations,
        rig.positions,
        np.array([pose.rotation for pose in poses]),
        np.array([pose.position for pose in poses]),
    )


def _rows(table: CornerTable) -> tuple[NDArray[np.int64], NDArray[np.int64], Array, Array]:
    return table.view, table.eye, table.point, table.pixel
