"""New corners where the picture has too few: FAST in the cells of a grid, the strongest first.

The segment test and score are those of Rosten and Drummond (ECCV 2006): nine neighbours in a row on a circle of 16
that are all brighter, or all darker, than the middle by a threshold; the score is the largest such threshold.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.own_legs import COARSE
from weaver_shared.config.odometry import FrontEndConfig

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]

CIRCLE = np.array(
    [
        (0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3, -3, -3, -2, -1),
        (-3, -3, -2, -1, 0, 1, 2, 3, 3, 3, 2, 1, 0, -1, -2, -3),
    ]
)
"""(2, 16) px right and down, in order around the middle."""

NOTHING_HIDDEN = np.zeros((0, 0), dtype=np.uint8)

ARC = 9
"""Neighbours in a row that make a corner."""


class CornerGrid:
    """Keeps features spread: each cell is filled up to its share, none nearer than the spacing to another."""

    def __init__(self, width: int, height: int, config: FrontEndConfig) -> None:
        self._config = config
        self._columns = np.linspace(config.border, width - config.border, config.columns + 1).astype(np.int64)
        self._rows = np.linspace(config.border, height - config.border, config.rows + 1).astype(np.int64)
        self._share = -(-config.features // (config.columns * config.rows))

    def refill(self, picture: Picture, taken: Array, cover: Picture | None = None) -> Array:
        """Corners (m, 2) in pixels to add to those `taken` (n, 2), none on what `cover` (of `own_legs`) hides."""
        config = self._config
        missing = config.features - len(taken)
        if missing <= 0:
            return np.zeros((0, 2))
        column = np.clip(np.searchsorted(self._columns, taken[:, 0], side="right") - 1, 0, config.columns - 1)
        row = np.clip(np.searchsorted(self._rows, taken[:, 1], side="right") - 1, 0, config.rows - 1)
        filled = np.bincount(row * config.columns + column, minlength=config.rows * config.columns)
        features = np.empty((config.features, 2))
        features[: len(taken)] = taken
        found = _fill_cells(
            np.ascontiguousarray(picture),
            self._columns,
            self._rows,
            np.argsort(filled, kind="stable"),
            self._share - filled,
            NOTHING_HIDDEN if cover is None else cover,
            features,
            len(taken),
            config.fast_threshold,
            config.spacing,
        )
        return features[len(taken) : found].copy()


@compiled
def _fill_cells(
    picture: Picture,
    columns: NDArray[np.int64],
    rows: NDArray[np.int64],
    order: NDArray[np.int64],
    wanted: NDArray[np.int64],
    cover: Picture,
    features: Array,
    count: int,
    threshold: int,
    spacing: float,
) -> int:
    """Append each cell's strongest corners to the first `count` rows of `features` until it is full: how many then."""
    across = len(columns) - 1
    widest = int(np.max(columns[1:] - columns[:-1]))
    highest = int(np.max(rows[1:] - rows[:-1]))
    score = np.empty((highest, widest), dtype=np.int64)
    ring = np.empty(16, dtype=np.int64)
    for flat in order:
        if wanted[flat] <= 0 or count == len(features):
            continue
        top, left = rows[flat // across], columns[flat % across]
        height, width = rows[flat // across + 1] - top, columns[flat % across + 1] - left
        score_cell(picture, top, left, height, width, threshold, ring, score)
        if cover.size:
            _clear_covered(score, top, left, height, width, cover)
        for n in range(count):
            _clear_about(score, height, width, features[n, 0] - left, features[n, 1] - top, spacing)
        for _ in range(min(wanted[flat], len(features) - count)):
            best, v, u = 0, 0, 0
            for i in range(height):
                for j in range(width):
                    if score[i, j] > best:
                        best, v, u = score[i, j], i, j
            if best == 0:
                break
            features[count, 0], features[count, 1] = left + u, top + v
            count += 1
            _clear_about(score, height, width, float(u), float(v), spacing)
    return count


@compiled
def score_cell(
    picture: Picture,
    top: int,
    left: int,
    height: int,
    width: int,
    threshold: int,
    ring: NDArray[np.int64],
    score: NDArray[np.int64],
) -> None:
    """FAST score of every pixel of a cell, 0 where there is no corner; `ring` (16,) is scratch."""
    for v in range(height):
        for u in range(width):
            score[v, u] = 0
            y, x = top + v, left + u
            middle = np.int64(picture[y, x])
            # Nine in a row hold one of each two opposite points, both brighter or both darker: most pixels fail here.
            up, down = np.int64(picture[y - 3, x]) - middle, np.int64(picture[y + 3, x]) - middle
            if max(up, down) <= threshold and min(up, down) >= -threshold:
                continue
            right, back = np.int64(picture[y, x + 3]) - middle, np.int64(picture[y, x - 3]) - middle
            if min(max(up, down), max(right, back)) <= threshold and max(min(up, down), min(right, back)) >= -threshold:
                continue
            brighter, darker = 0, 0
            for n in range(16):
                ring[n] = np.int64(picture[y + CIRCLE[1, n], x + CIRCLE[0, n]]) - middle
                if ring[n] > threshold:
                    brighter |= 1 << n
                elif ring[n] < -threshold:
                    darker |= 1 << n
            if _has_arc(brighter) or _has_arc(darker):
                score[v, u] = _arc_score(ring, threshold)


@compiled
def _has_arc(bits: int) -> bool:
    """Are ARC of 16 bits in a ring set in a row?"""
    bits |= bits << 16
    run = bits & (bits >> 1)
    run &= run >> 2
    run &= run >> 4
    run &= bits >> (ARC - 1)
    return (run & 0xFFFF) != 0


@compiled
def _arc_score(ring: NDArray[np.int64], threshold: int) -> int:
    """Largest difference that some arc exceeds or falls below throughout; 0 if none does so by the threshold."""
    best = threshold
    for start in range(16):
        least, most = ring[start], ring[start]
        for n in range(1, ARC):
            value = ring[(start + n) & 15]
            least, most = min(least, value), max(most, value)
            if least <= best and -most <= best:
                break
        best = max(best, least, -most)
    return best if best > threshold else 0


@compiled
def _clear_covered(score: NDArray[np.int64], top: int, left: int, height: int, width: int, cover: Picture) -> None:
    for v in range(height):
        for u in range(width):
            if score[v, u] and cover[(top + v) // COARSE, (left + u) // COARSE]:
                score[v, u] = 0


@compiled
def _clear_about(score: NDArray[np.int64], height: int, width: int, x: float, y: float, spacing: float) -> None:
    """No corner nearer than `spacing` to (x, y)."""
    for v in range(max(0, int(y - spacing)), min(height, int(y + spacing) + 2)):
        for u in range(max(0, int(x - spacing)), min(width, int(x + spacing) + 2)):
            if (u - x) ** 2 + (v - y) ** 2 < spacing * spacing:
                score[v, u] = 0
