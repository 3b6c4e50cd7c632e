"""Finds a chessboard's inner corners; only whole boards count, as nothing on them tells one corner from another."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.sightings import Picture, Sighting
from robot_agent.calibration.target import Checkerboard

_FLAGS = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE
_REFINED = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 1e-3)


class ChessboardDetector:
    def __init__(self, board: Checkerboard) -> None:
        self._size = (board.columns, board.rows)

    def detect(self, picture: Picture) -> Sighting | None:
        """All corners, refined, or None."""
        found, pixels = cv2.findChessboardCorners(picture, self._size, flags=_FLAGS)
        if not found:
            return None
        grid = pixels.reshape(self._size[1], self._size[0], 2)
        steps = [np.linalg.norm(np.diff(grid, axis=axis), axis=2).min() for axis in (0, 1)]
        reach = int(np.clip(0.4 * min(steps), 2, 11))
        refined = cv2.cornerSubPix(picture, pixels, (reach, reach), (-1, -1), _REFINED).reshape(-1, 2)
        if self._upside_down(picture, refined):
            refined = refined[::-1]
        return Sighting(corners=np.arange(len(refined)), pixels=refined.astype(np.float64))

    def _upside_down(self, picture: Picture, pixels: NDArray[np.float32]) -> bool:
        """Whether the numbering began at the wrong end: the first inner square is the black one of the two ends.

        A board with both counts even or both odd looks the same from either end and stays as it was found.
        """
        columns, rows = self._size
        if (columns + rows) % 2 == 0:
            return False
        grid = pixels.reshape(rows, columns, 2)
        ends = np.array([grid[:2, :2].mean(axis=(0, 1)), grid[-2:, -2:].mean(axis=(0, 1))], dtype=np.float32)
        first, last = cv2.remap(picture, ends[:, 0], ends[:, 1], cv2.INTER_LINEAR).ravel()
        return bool(first > last)
