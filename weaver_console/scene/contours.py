"""Contour lines of the ground: where a tile's triangles cross whole multiples of the interval."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.ground import Ground, TileIndex, elevation_of
from weaver_console.scene.lines import NONE, Lines

Array = NDArray[np.float64]

INTERVAL = 0.05
"""m between two lines."""

TILES_AN_UPDATE = 6
LIFT = 0.004
"""m over the ground, so that it does not swallow them."""

_COLOUR = (24, 28, 34)


class ContourFigure:
    """Lines of every tile under `name`, drawn while they are wanted, anew where the ground has changed."""

    def __init__(self, scene: Any, name: str) -> None:
        self._scene = scene
        self._name = name
        self._lines: dict[TileIndex, Lines] = {}
        self._drawn: dict[TileIndex, int] = {}

    def update(self, ground: Ground, wanted: bool) -> None:
        if not wanted:
            self._clear()
            return
        left = TILES_AN_UPDATE
        for index, version in list(ground.versions.items()):
            if self._drawn.get(index) == version:
                continue
            if left == 0:
                return
            left -= 1
            self._drawn[index] = version
            if index not in self._lines:
                name = f"{self._name}/{index[0]}_{index[1]}"
                self._lines[index] = Lines(self._scene, name, _COLOUR, thickness=0.005)
            self._lines[index].show(tile_contours(ground, index))

    def _clear(self) -> None:
        if self._drawn:
            for lines in self._lines.values():
                lines.show(NONE)
            self._drawn = {}


def tile_contours(ground: Ground, index: TileIndex) -> Array:
    """Segments (n, 2, 3) in world of a tile and of the seam to its neighbours in +x and +y."""
    tile = ground.tiles[index]
    height = np.full((tile.size + 1, tile.size + 1), np.nan)
    for di, dj in ((0, 0), (1, 0), (0, 1), (1, 1)):
        part = ground.tiles.get((tile.i + di, tile.j + dj))
        if part is None or part.size != tile.size or part.cell != tile.cell:
            continue
        to = (
            slice(tile.size, None) if di else slice(0, tile.size),
            slice(tile.size, None) if dj else slice(0, tile.size),
        )
        take = (slice(0, 1) if di else slice(None), slice(0, 1) if dj else slice(None))
        height[to] = elevation_of(part)[take]
    rows, columns = np.indices(height.shape)
    x, y = (tile.i * tile.size + rows + 0.5) * tile.cell, (tile.j * tile.size + columns + 0.5) * tile.cell
    return contours(np.stack([x, y, height], axis=-1), INTERVAL)


def contours(places: Array, interval: float) -> Array:
    """Segments (n, 2, 3) at whole multiples of `interval` through a grid of places (rows, columns, 3), NaN unknown."""
    a, b, c, d = places[:-1, :-1], places[1:, :-1], places[1:, 1:], places[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)]).reshape(-1, 3, 3)
    triangles = triangles[np.isfinite(triangles).all(axis=(1, 2))]
    if not len(triangles):
        return NONE
    lowest, highest = triangles[:, :, 2].min(axis=1), triangles[:, :, 2].max(axis=1)
    levels = np.arange(np.ceil(lowest.min() / interval), np.floor(highest.max() / interval) + 1.0) * interval
    pieces = [_crossing(triangles[(lowest < level) & (highest >= level)], float(level)) for level in levels]
    return np.concatenate(pieces) if pieces else NONE


def _crossing(triangles: Array, level: float) -> Array:
    """Where each triangle (n, 3, 3), one or two corners of which lie below the level, is cut by it, (n, 2, 3)."""
    below = triangles[:, :, 2] < level
    alone = np.argmax(below == (below.sum(axis=1) == 1)[:, None], axis=1)
    row = np.arange(len(triangles))
    tip, left, right = (triangles[row, (alone + turn) % 3] for turn in range(3))
    ends = []
    for other in (left, right):
        share = (level - tip[:, 2]) / (other[:, 2] - tip[:, 2])
        ends.append(tip + share[:, None] * (other - tip))
    segments: Array = np.stack(ends, axis=1)
    segments[..., 2] += LIFT
    return segments
