"""Where a landmark is seen against where it should be: reprojection errors of both eyes and their derivatives.

A picture is taken at its stamp plus the time offset, so each frame's pose is moved along its velocity and turn rate by
the offset before projecting, and its eyes sit on the IMU as the rig's correction says. What a change of these common
unknowns does to a sighting is what a change of its frame's pose would do: `common_as_poses` says of which.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled, compiled_for_speed
from robot_agent.odometry.landmarks import Eyes, Landmarks, Views, views_of
from robot_agent.odometry.rotations import exponential
from robot_agent.odometry.window_state import (
    COMMON,
    POSITION,
    RIG_ROTATION,
    RIG_SHIFT,
    ROTATION,
    TIME_OFFSET,
    Frames,
)

Array = NDArray[np.float64]

POSE = 6
"""Unknowns of a frame that a picture sees: rotation and position."""

BEHIND = 1e6
"""sigmas: the error of a point that is not in front of the eye."""


@compiled
def exposure_views(frames: Frames, eyes: Eyes, count: int) -> tuple[Array, Array, Views]:
    """Rotation and position of the IMU when each picture was taken, and both eyes' views from there."""
    dt = frames.time_offset[0]
    rotation = np.empty((count, 3, 3))
    position = np.empty((count, 3))
    for k in range(count):
        rotation[k] = frames.rotation[k] @ exponential(frames.rate[k] * dt)
        position[k] = frames.position[k] + frames.velocity[k] * dt
    return rotation, position, views_of(rotation, position, mounted(frames, eyes), count)


@compiled
def mounted(frames: Frames, eyes: Eyes) -> Eyes:
    """The eyes where they sit on the IMU by the estimate, from where they are by their calibration."""
    corrected = Eyes(np.empty((2, 3, 3)), np.empty((2, 3)))
    rig_from_imu = np.ascontiguousarray(frames.rig_rotation.T)
    for e in range(2):
        corrected.rotation[e] = eyes.rotation[e] @ rig_from_imu
        corrected.translation[e] = eyes.translation[e] - eyes.rotation[e] @ frames.rig_shift
    return corrected


@compiled
def common_as_poses(frames: Frames, rotation: Array, count: int) -> Array:
    """The change of the exposures' poses (POSE * count, COMMON) by each common unknown, as the eyes see it.

    `rotation` is that of the exposures.
    """
    change = np.zeros((POSE * count, COMMON))
    for k in range(count):
        base = POSE * k
        world_from_rig = rotation[k] @ frames.rig_rotation
        for a in range(3):
            change[base + ROTATION + a, TIME_OFFSET] = frames.rate[k, a]
            change[base + POSITION + a, TIME_OFFSET] = frames.velocity[k, a]
            change[base + ROTATION + a, RIG_ROTATION + a] = 1.0
            for b in range(3):
                change[base + POSITION + a, RIG_SHIFT + b] = world_from_rig[a, b]
    return change


@compiled_for_speed
def whitened_error(
    views: Views, landmarks: Landmarks, row: int, k: int, e: int, per_sigma: float
) -> tuple[float, float]:
    """Projection less observation in sigmas; far beyond any gate when the point is not in front of the eye."""
    m, o = views.rotation, views.translation
    p0, p1, p2 = landmarks.point[row, 0], landmarks.point[row, 1], landmarks.point[row, 2]
    z = m[k, e, 2, 0] * p0 + m[k, e, 2, 1] * p1 + m[k, e, 2, 2] * p2 + o[k, e, 2]
    if z < 0.05:
        return BEHIND, BEHIND
    x = (m[k, e, 0, 0] * p0 + m[k, e, 0, 1] * p1 + m[k, e, 0, 2] * p2 + o[k, e, 0]) / z
    y = (m[k, e, 1, 0] * p0 + m[k, e, 1, 1] * p1 + m[k, e, 1, 2] * p2 + o[k, e, 1]) / z
    observed = landmarks.observation
    return (x - observed[row, k, e, 0]) * per_sigma, (y - observed[row, k, e, 1]) * per_sigma


@compiled_for_speed
def observation_rows(
    rotation: Array, position: Array, eyes: Eyes, views: Views, points: Array, row: int, k: int, e: int, rows: Array
) -> None:
    """Derivatives of one eye's error on the plane z = 1 to its frame's pose and to point `row` of `points`.

    They go to the rows 2 e (x) and 2 e + 1 (y) of `rows`, the pose's into its columns 0..5, the point's into 6..8.
    """
    m, o, c = views.rotation, views.translation, eyes.rotation
    p0, p1, p2 = points[row, 0], points[row, 1], points[row, 2]
    d0, d1, d2 = p0 - position[k, 0], p1 - position[k, 1], p2 - position[k, 2]
    q0 = rotation[k, 0, 0] * d0 + rotation[k, 1, 0] * d1 + rotation[k, 2, 0] * d2
    q1 = rotation[k, 0, 1] * d0 + rotation[k, 1, 1] * d1 + rotation[k, 2, 1] * d2
    q2 = rotation[k, 0, 2] * d0 + rotation[k, 1, 2] * d1 + rotation[k, 2, 2] * d2
    per_z = 1.0 / max(0.05, m[k, e, 2, 0] * p0 + m[k, e, 2, 1] * p1 + m[k, e, 2, 2] * p2 + o[k, e, 2])
    for r in range(2):
        n = 2 * e + r
        along = per_z * (m[k, e, r, 0] * p0 + m[k, e, r, 1] * p1 + m[k, e, r, 2] * p2 + o[k, e, r])
        for a in range(3):
            rows[n, 6 + a] = per_z * (m[k, e, r, a] - along * m[k, e, 2, a])
            rows[n, 3 + a] = -rows[n, 6 + a]
        g0 = per_z * (c[e, r, 0] - along * c[e, 2, 0])
        g1 = per_z * (c[e, r, 1] - along * c[e, 2, 1])
        g2 = per_z * (c[e, r, 2] - along * c[e, 2, 2])
        rows[n, 0] = g1 * q2 - g2 * q1
        rows[n, 1] = g2 * q0 - g0 * q2
        rows[n, 2] = g0 * q1 - g1 * q0


@compiled
def reject(
    frames: Frames, landmarks: Landmarks, eyes: Eyes, count: int, per_sigma: float, gate: float
) -> tuple[NDArray[np.bool_], float]:
    """Unsee every observation beyond `gate` sigmas; True for the rows whose newest observation was among them.

    Also tells the root mean square of what is left of points seen more than twice, in sigmas; NaN without any.
    """
    _, _, views = exposure_views(frames, eyes, count)
    dead = np.zeros(landmarks.identity.shape[0], dtype=np.bool_)
    squares, number = 0.0, 0
    for row in range(landmarks.identity.shape[0]):
        if not landmarks.solved[row]:
            continue
        sightings = 0
        for k in range(count):
            sightings += landmarks.seen[row, k] > 0
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
                elif sightings > 2:
                    squares += ex * ex + ey * ey
                    number += 2
    return dead, np.sqrt(squares / number) if number else np.nan
