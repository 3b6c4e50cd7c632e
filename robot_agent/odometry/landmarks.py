"""The points the window sees: one row a landmark, one column a frame."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled

Array = NDArray[np.float64]

NEAREST, FARTHEST = 0.1, 100.0
"""m, depth of points that may be triangulated."""

LEFT, RIGHT = 1, 2
"""Bits of `seen`."""


class Landmarks(NamedTuple):
    identity: NDArray[np.int64]  # (rows,) of the track, -1 free
    solved: NDArray[np.bool_]  # (rows,) the point is known
    point: Array  # (rows, 3) in world
    observation: Array  # (rows, slots, 2, 2) eye, undistorted x and y on the plane z = 1
    seen: NDArray[np.uint8]  # (rows, slots) bits LEFT and RIGHT

    @staticmethod
    def of(rows: int, slots: int) -> Landmarks:
        return Landmarks(
            identity=np.full(rows, -1, dtype=np.int64),
            solved=np.zeros(rows, dtype=np.bool_),
            point=np.zeros((rows, 3)),
            observation=np.zeros((rows, slots, 2, 2)),
            seen=np.zeros((rows, slots), dtype=np.uint8),
        )

    def remove_frame(self, slot: int) -> None:
        """Close the gap of a frame and free the rows nobody sees any more."""
        close_gap(self, slot)

    def forget(self, rows: NDArray[np.bool_]) -> None:
        self.identity[rows] = -1
        self.solved[rows] = False
        self.seen[rows] = 0

    def see(
        self, slot: int, identity: NDArray[np.int64], observation: Array, seen: NDArray[np.uint8]
    ) -> NDArray[np.int64]:
        """Enter a frame's tracks; the row of each, -1 where the table is full."""
        return enter(self, slot, identity, observation, seen)


@compiled
def enter(
    landmarks: Landmarks, slot: int, identity: NDArray[np.int64], observation: Array, seen: NDArray[np.uint8]
) -> NDArray[np.int64]:
    """Write a frame's tracks to their rows, new ones to free rows; the row of each, -1 where there was none left."""
    rows = np.full(len(identity), -1, dtype=np.int64)
    for n in range(len(identity)):
        for row in range(landmarks.identity.shape[0]):
            if landmarks.identity[row] == identity[n]:
                rows[n] = row
                break
    free = 0
    for n in range(len(identity)):
        if rows[n] < 0:
            while free < landmarks.identity.shape[0] and landmarks.identity[free] >= 0:
                free += 1
            if free == landmarks.identity.shape[0]:
                continue
            rows[n] = free
            landmarks.identity[free] = identity[n]
        landmarks.observation[rows[n], slot] = observation[n]
        landmarks.seen[rows[n], slot] = seen[n]
    return rows


@compiled
def close_gap(landmarks: Landmarks, slot: int) -> None:
    """Move the frames after `slot` one down; a row that nobody sees any more is free."""
    slots = landmarks.seen.shape[1]
    for row in range(landmarks.identity.shape[0]):
        if landmarks.identity[row] < 0:
            continue
        seen_at_all = False
        for k in range(slots):
            if k >= slot:
                landmarks.seen[row, k] = landmarks.seen[row, k + 1] if k + 1 < slots else 0
            if k >= slot and landmarks.seen[row, k]:
                for e in range(2):
                    for a in range(2):
                        landmarks.observation[row, k, e, a] = landmarks.observation[row, k + 1, e, a]
            seen_at_all |= landmarks.seen[row, k] > 0
        if not seen_at_all:
            landmarks.identity[row] = -1
            landmarks.solved[row] = False


class Eyes(NamedTuple):
    """The stereo rig: where each eye sits on the IMU."""

    rotation: Array  # (2, 3, 3) camera_from_imu
    translation: Array  # (2, 3)


class Views(NamedTuple):
    """Every eye of every frame as an affine map from world."""

    rotation: Array  # (slots, 2, 3, 3) camera_from_world
    translation: Array  # (slots, 2, 3)


@compiled
def views_of(rotation: Array, position: Array, eyes: Eyes, count: int) -> Views:
    views = Views(np.empty((count, 2, 3, 3)), np.empty((count, 2, 3)))
    for k in range(count):
        imu_from_world = np.ascontiguousarray(rotation[k].T)
        for e in range(2):
            views.rotation[k, e] = eyes.rotation[e] @ imu_from_world
            views.translation[k, e] = eyes.translation[e] - views.rotation[k, e] @ position[k]
    return views


@compiled
def triangulate(landmarks: Landmarks, views: Views, count: int, parallax: float, tolerance: float) -> None:
    """Give a point to each landmark whose rays open by more than `parallax` (rad): where the rays pass nearest.

    The point must lie in front of every eye that saw it and be seen there within `tolerance` (on the plane z = 1).
    """
    least = np.cos(parallax)
    rays = np.empty((2 * count, 3))
    for row in range(landmarks.identity.shape[0]):
        if landmarks.identity[row] < 0 or landmarks.solved[row]:
            continue
        normal: Array = np.zeros((3, 3))
        target: Array = np.zeros(3)
        found = 0
        for k in range(count):
            for e in range(2):
                if not landmarks.seen[row, k] & (1 << e):
                    continue
                world_from_camera = np.ascontiguousarray(views.rotation[k, e].T)
                x, y = landmarks.observation[row, k, e]
                ray = world_from_camera @ np.array([x, y, 1.0]) / np.sqrt(x * x + y * y + 1.0)
                centre = -world_from_camera @ views.translation[k, e]
                across = np.eye(3) - np.outer(ray, ray)
                normal += across
                target += across @ centre
                rays[found] = ray
                found += 1
        narrowest = 1.0
        for a in range(found):
            narrowest = min(narrowest, rays[0] @ rays[a])
        if narrowest > least:
            continue
        point = np.linalg.solve(normal, target).astype(np.float64)
        landmarks.solved[row] = _agrees(landmarks, views, count, row, point, tolerance)
        landmarks.point[row] = point


@compiled
def _agrees(landmarks: Landmarks, views: Views, count: int, row: int, point: Array, tolerance: float) -> bool:
    for k in range(count):
        for e in range(2):
            if landmarks.seen[row, k] & (1 << e):
                seen = views.rotation[k, e] @ point + views.translation[k, e]
                if not NEAREST < seen[2] < FARTHEST:
                    return False
                error = np.abs(seen[:2] / seen[2] - landmarks.observation[row, k, e])
                if not max(error[0], error[1]) < tolerance:
                    return False
    return True
