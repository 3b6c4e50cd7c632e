"""Normal equations of a rig looking at a target: dense in the rig, one 6 x 6 block per view."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.compiled import compiled
from robot_agent.calibration.lens import project_point

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


@compiled
def residuals(
    models: Numbers,
    intrinsics: Array,
    eye_rotations: Array,
    eye_positions: Array,
    view_rotations: Array,
    view_positions: Array,
    view: Numbers,
    eye: Numbers,
    points: Array,
    pixels: Array,
) -> Array:
    """Projected minus seen (n, 2), px; NaN for a point behind a lens."""
    result = np.empty((len(view), 2))
    by_point, by_intrinsics = np.empty((2, 3)), np.empty((2, 8))
    for k in range(len(view)):
        v, e = view[k], eye[k]
        first = view_rotations[v] @ points[k] + view_positions[v]
        project_point(
            models[e], intrinsics[e], eye_rotations[e] @ first + eye_positions[e], result[k], by_point, by_intrinsics
        )
        result[k] -= pixels[k]
    return result


@compiled
def normal_equations(
    models: Numbers,
    intrinsics: Array,
    eye_rotations: Array,
    eye_positions: Array,
    view_rotations: Array,
    view_positions: Array,
    view: Numbers,
    eye: Numbers,
    points: Array,
    pixels: Array,
    weights: Array,
) -> tuple[Array, Array, Array, Array, Array]:
    """Blocks view-view (v, 6, 6), view-rig (v, 6, m), rig-rig (m, m), gradients (v, 6), (m,) of the weighted squares.

    Rig columns: 8 intrinsics per eye, then 6 per eye but the first (rotation, translation, applied after its pose).
    """
    views, eyes = len(view_rotations), len(models)
    size = 8 * eyes + 6 * (eyes - 1)
    by_view, across, by_rig = np.zeros((views, 6, 6)), np.zeros((views, 6, size)), np.zeros((size, size))
    view_gradient, rig_gradient = np.zeros((views, 6)), np.zeros(size)
    pixel, by_point, by_intrinsics = np.empty(2), np.empty((2, 3)), np.empty((2, 8))
    turning = np.empty((3, 6))
    for k in range(len(view)):
        v, e = view[k], eye[k]
        first = view_rotations[v] @ points[k] + view_positions[v]
        seen = eye_rotations[e] @ first + eye_positions[e]
        project_point(models[e], intrinsics[e], seen, pixel, by_point, by_intrinsics)
        error = pixel - pixels[k]
        weight = weights[k]
        if not (weight > 0.0 and np.isfinite(error[0]) and np.isfinite(error[1])):
            continue
        _moving(first, turning)
        by_pose = by_point @ (eye_rotations[e] @ turning)
        row = np.zeros((2, size))
        row[:, 8 * e : 8 * e + 8] = by_intrinsics
        if e > 0:
            _moving(seen, turning)
            begin = 8 * eyes + 6 * (e - 1)
            row[:, begin : begin + 6] = by_point @ turning
        by_view[v] += weight * (by_pose.T @ by_pose)
        view_gradient[v] += weight * (by_pose.T @ error)
        across[v] += weight * (by_pose.T @ row)
        by_rig += weight * (row.T @ row)
        rig_gradient += weight * (row.T @ error)
    return by_view, across, by_rig, view_gradient, rig_gradient


@compiled
def _moving(point: Array, by_step: Array) -> None:
    """Derivative (3, 6) of a point by a small motion of its frame: rotation, then translation."""
    by_step[:, :] = 0.0
    by_step[0, 1], by_step[0, 2] = point[2], -point[1]
    by_step[1, 0], by_step[1, 2] = -point[2], point[0]
    by_step[2, 0], by_step[2, 1] = point[1], -point[0]
    by_step[0, 3] = by_step[1, 4] = by_step[2, 5] = 1.0
