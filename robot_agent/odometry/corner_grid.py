"""New corners where the picture has too few: FAST in the cells of a grid, the strongest first."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.odometry import FrontEndConfig

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]


class CornerGrid:
    """Keeps features spread: each cell is filled up to its share, none nearer than the spacing to another."""

    def __init__(self, width: int, height: int, config: FrontEndConfig) -> None:
        self._config = config
        self._detector = cv2.FastFeatureDetector.create(threshold=config.fast_threshold, nonmaxSuppression=True)
        columns = np.linspace(config.border, width - config.border, config.columns + 1).astype(int)
        rows = np.linspace(config.border, height - config.border, config.rows + 1).astype(int)
        self._columns, self._rows = columns, rows
        self._share = -(-config.features // (config.columns * config.rows))

    def refill(self, picture: Picture, taken: Array) -> Array:
        """Corners (m, 2) in pixels to add to those `taken` (n, 2)."""
        config = self._config
        missing = config.features - len(taken)
        if missing <= 0:
            return np.zeros((0, 2))
        column = np.clip(np.searchsorted(self._columns, taken[:, 0], side="right") - 1, 0, config.columns - 1)
        row = np.clip(np.searchsorted(self._rows, taken[:, 1], side="right") - 1, 0, config.rows - 1)
        filled = np.zeros((config.rows, config.columns), dtype=int)
        np.add.at(filled, (row, column), 1)
        added: list[Array] = []
        for flat in np.argsort(filled, axis=None, kind="stable"):
            r, c = divmod(int(flat), config.columns)
            wanted = min(self._share - int(filled[r, c]), missing - len(added))
            if wanted > 0:
                added += self._best_of_cell(picture, r, c, wanted, taken, added)
        return np.array(added) if added else np.zeros((0, 2))

    def _best_of_cell(
        self, picture: Picture, row: int, column: int, wanted: int, taken: Array, added: list[Array]
    ) -> list[Array]:
        top, bottom = self._rows[row], self._rows[row + 1]
        left, right = self._columns[column], self._columns[column + 1]
        # FAST looks 3 px around a pixel, so the cell is cut out with that much around it.
        corners = self._detector.detect(picture[top - 3 : bottom + 3, left - 3 : right + 3])
        if not corners:
            return []
        strongest = sorted(corners, key=lambda corner: -corner.response)[: 8 * wanted]
        near = [*taken[(np.abs(taken - ((left + right) / 2, (top + bottom) / 2)) < 120).all(axis=1)], *added]
        others = np.array(near).reshape(-1, 2)
        chosen: list[Array] = []
        for corner in strongest:
            at = np.array([corner.pt[0] + left - 3, corner.pt[1] + top - 3])
            if len(others) and ((others - at) ** 2).sum(axis=1).min() < self._config.spacing**2:
                continue
            chosen.append(at)
            others = np.vstack([others, at])
            if len(chosen) == wanted:
                break
        return chosen
