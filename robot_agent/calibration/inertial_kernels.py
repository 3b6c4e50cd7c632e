"""Normal equations of a pose spline seen by camera and IMU: a band for the spline, a dense border for the rest.

Border columns: imu_from_camera (rotation on its right, then translation), time offset, the target's scale, gravity in
the target's frame, then gyro and accelerometer bias at each node. Spline columns: rotation (on its
right) and position of each control.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.compiled import compiled
from robot_agent.calibration.lens import project_point
from robot_agent.calibration.spline import cross_matrix, rotation_at, weights

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

CONTROL = 6
"""Columns per control: rotation and position."""

REACH = 36
"""Columns one instant depends on: six controls."""

TURN, MOVE, OFFSET, SCALE, PULL, BIASES = 0, 3, 6, 7, 8, 11
"""Where in the border each part begins."""


@compiled
def pose_at(
    matrix: Array,
    interval: float,
    time: float,
    rotations: Array,
    positions: Array,
    lambdas: Array,
    by_turn: Array,
    by_rate: Array,
) -> tuple[int, Array, Array, Array, Array, Array]:
    """First control, rotation, angular velocity (in the IMU), position, velocity, acceleration (in the target)."""
    first = min(max(int(time / interval), 0), len(rotations) - matrix.shape[0])
    weights(matrix, time / interval - first, interval, lambdas)
    rotation, rate = rotation_at(rotations[first : first + 6], lambdas, by_turn, by_rate)
    motion = np.zeros((3, 3))
    for order in range(3):
        for j in range(6):
            share = lambdas[order, j] - (lambdas[order, j + 1] if j < 5 else 0.0)
            motion[order] += share * positions[first + j]
    return first, rotation, rate, motion[0], motion[1], motion[2]


@compiled
def add_rows(
    rows: Array, errors: Array, begin: int, border: Numbers, band: Array, across: Array, dense: Array, gradient: Array,
    border_gradient: Array,
) -> None:  # fmt: skip
    """Add whitened rows (k, 36 + b): columns `begin`... of the band, then those of the border numbered in `border`."""
    squares = np.ascontiguousarray(rows.T) @ rows
    slope = np.ascontiguousarray(rows.T) @ errors
    for a in range(REACH):
        gradient[begin + a] += slope[a]
        for b in range(a + 1):
            band[a - b, begin + b] += squares[a, b]
        for b in range(len(border)):
            across[begin + a, border[b]] += squares[a, REACH + b]
    for a in range(len(border)):
        border_gradient[border[a]] += slope[REACH + a]
        for b in range(len(border)):
            dense[border[a], border[b]] += squares[REACH + a, REACH + b]


@compiled
def add_inertia(
    matrix: Array,
    interval: float,
    rotations: Array,
    positions: Array,
    gravity: Array,
    biases: Array,
    node_interval: float,
    times: Array,
    rates: Array,
    forces: Array,
    sigmas: Array,
    band: Array,
    across: Array,
    dense: Array,
    gradient: Array,
    border_gradient: Array,
    errors: Array,
) -> None:
    """Samples (n, 3) at `times` (s from the spline's begin); whitened errors (n, 6) are left in `errors`."""
    lambdas, by_turn, by_rate = np.empty((3, 6)), np.empty((6, 3, 3)), np.empty((6, 3, 3))
    border = np.empty(15, dtype=np.int64)
    rows = np.empty((6, REACH + 15))
    for k in range(len(times)):
        first, rotation, rate, _, _, acceleration = pose_at(
            matrix, interval, times[k], rotations, positions, lambdas, by_turn, by_rate
        )
        back = np.ascontiguousarray(rotation.T)
        force = back @ (acceleration - gravity)
        node = min(int(times[k] / node_interval), len(biases) - 2)
        late = times[k] / node_interval - node
        bias = (1.0 - late) * biases[node] + late * biases[node + 1]
        rows[:, :] = 0.0
        turned = cross_matrix(force)
        for j in range(6):
            share = lambdas[2, j] - (lambdas[2, j + 1] if j < 5 else 0.0)
            rows[:3, 6 * j : 6 * j + 3] = by_rate[j] / sigmas[0]
            rows[3:, 6 * j : 6 * j + 3] = turned @ by_turn[j] / sigmas[1]
            rows[3:, 6 * j + 3 : 6 * j + 6] = share / sigmas[1] * back
        rows[3:, REACH : REACH + 3] = -back / sigmas[1]
        for i in range(3):
            border[i] = PULL + i
            for part in range(2):
                border[3 + 3 * part + i] = BIASES + 6 * node + 3 * part + i
                border[9 + 3 * part + i] = BIASES + 6 * (node + 1) + 3 * part + i
                rows[3 * part + i, REACH + 3 + 3 * part + i] = (1.0 - late) / sigmas[part]
                rows[3 * part + i, REACH + 9 + 3 * part + i] = late / sigmas[part]
        errors[k, :3] = (rate + bias[:3] - rates[k]) / sigmas[0]
        errors[k, 3:] = (force + bias[3:] - forces[k]) / sigmas[1]
        add_rows(rows, errors[k], 6 * first, border, band, across, dense, gradient, border_gradient)


@compiled
def add_pictures(
    matrix: Array,
    interval: float,
    rotations: Array,
    positions: Array,
    imu_from_camera: Array,
    camera_in_imu: Array,
    time_offset: float,
    stamps: Array,
    first_corner: Numbers,
    models: Numbers,
    intrinsics: Array,
    eye_rotations: Array,
    eye_positions: Array,
    eyes: Numbers,
    points: Array,
    pixels: Array,
    sigma: float,
    bend: float,
    band: Array,
    across: Array,
    dense: Array,
    gradient: Array,
    border_gradient: Array,
    errors: Array,
) -> float:
    """Pictures taken at `stamps` (n,), corners of picture k from `first_corner[k]` on; Huber's cost of all corners.

    Whitened errors (corners, 2) are left in `errors`.
    """
    lambdas, by_turn, by_rate = np.empty((3, 6)), np.empty((6, 3, 3)), np.empty((6, 3, 3))
    pixel, by_point, by_intrinsics = np.empty(2), np.empty((2, 3)), np.empty((2, 8))
    border = np.arange(PULL)
    camera_from_imu = np.ascontiguousarray(imu_from_camera.T)
    cost = 0.0
    for k in range(len(stamps)):
        first, rotation, rate, position, velocity, _ = pose_at(
            matrix, interval, stamps[k] + time_offset, rotations, positions, lambdas, by_turn, by_rate
        )
        back = np.ascontiguousarray(rotation.T)
        camera_from_target = camera_from_imu @ back
        squares, slope = np.zeros((7, 7)), np.zeros(7)
        for c in range(first_corner[k], first_corner[k + 1]):
            seen = camera_from_target @ (points[c] - position) - camera_from_imu @ camera_in_imu
            e = eyes[c]
            project_point(
                models[e], intrinsics[e], eye_rotations[e] @ seen + eye_positions[e], pixel, by_point, by_intrinsics
            )
            errors[c] = (pixel - pixels[c]) / sigma
            length = np.sqrt(errors[c, 0] * errors[c, 0] + errors[c, 1] * errors[c, 1])
            if not np.isfinite(length):
                errors[c] = 0.0
                cost += 1e4
                continue
            weight = 1.0
            if length > bend:
                weight = bend / length
                cost += bend * (length - 0.5 * bend)
            else:
                cost += 0.5 * length * length
            by_place = by_point @ eye_rotations[e] / sigma
            by_step = np.empty((2, 7))
            by_step[:, :3] = -by_place @ cross_matrix(seen)
            by_step[:, 3:6] = by_place
            # Target and distance between the eyes grow together: the latter was measured with the former.
            by_step[:, 6] = by_place @ (camera_from_target @ points[c]) + by_point @ eye_positions[e] / sigma
            squares += weight * (by_step.T @ by_step)
            slope += weight * (by_step.T @ errors[c])
        chain = np.zeros((7, REACH + PULL))
        chain[6, REACH + SCALE] = 1.0
        # A turn of the IMU (in its frame) and how it moves the camera, by its lever.
        by_imu_turn = np.zeros((6, 3))
        by_imu_turn[:3] = -camera_from_imu
        by_imu_turn[3:] = camera_from_imu @ cross_matrix(camera_in_imu)
        for j in range(6):
            share = lambdas[0, j] - (lambdas[0, j + 1] if j < 5 else 0.0)
            chain[:6, 6 * j : 6 * j + 3] = by_imu_turn @ by_turn[j]
            chain[3:6, 6 * j + 3 : 6 * j + 6] = -share * camera_from_target
        for i in range(3):
            chain[i, REACH + TURN + i] = -1.0
        chain[3:6, REACH + MOVE : REACH + MOVE + 3] = -camera_from_imu
        chain[:6, REACH + OFFSET] = by_imu_turn @ rate
        chain[3:6, REACH + OFFSET] -= camera_from_target @ velocity
        add_block(squares, slope, chain, 6 * first, border, band, across, dense, gradient, border_gradient)
    return cost


@compiled
def add_block(
    squares: Array, slope: Array, chain: Array, begin: int, border: Numbers, band: Array, across: Array, dense: Array,
    gradient: Array, border_gradient: Array,
) -> None:  # fmt: skip
    """Add a block (k, k) of normal equations through the derivative `chain` (k, 36 + b) of its columns."""
    spread = np.ascontiguousarray(chain.T)
    wide = spread @ (squares @ chain)
    slopes = spread @ slope
    for a in range(REACH):
        gradient[begin + a] += slopes[a]
        for b in range(a + 1):
            band[a - b, begin + b] += wide[a, b]
        for b in range(len(border)):
            across[begin + a, border[b]] += wide[a, REACH + b]
    for a in range(len(border)):
        border_gradient[border[a]] += slopes[REACH + a]
        for b in range(len(border)):
            dense[border[a], border[b]] += wide[REACH + a, REACH + b]
