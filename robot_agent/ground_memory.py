"""The ground as the walking process remembers it: the newest tile of every place of the map."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.messages import MapTile

Array = NDArray[np.float64]

UNKNOWN_ELEVATION = -32768
UNSURE_MM = 50
"""Standard deviation from which on a height is not counted as known."""

MOST_TILES = 4000

FAR = 2**24
"""Tiles from the origin are fewer than half of this."""


class GroundMemory:
    """Filled on the bus's threads, read on others: a tile is replaced whole."""

    def __init__(self) -> None:
        self._tiles: dict[tuple[int, int], MapTile] = {}

    def put(self, tile: MapTile) -> None:
        self._tiles.pop((tile.i, tile.j), None)
        self._tiles[tile.i, tile.j] = tile
        while len(self._tiles) > MOST_TILES:
            self._tiles.pop(next(iter(self._tiles)))

    def heights(self, x: Array, y: Array) -> Array:
        """m at world points of any one shape; NaN where the map knows none."""
        heights = np.full(x.shape, np.nan)
        tiles = self._tiles.copy()
        if not tiles:
            return heights
        any_tile = next(iter(tiles.values()))
        row, column = np.floor(x / any_tile.cell).astype(int), np.floor(y / any_tile.cell).astype(int)
        i, j = row // any_tile.size, column // any_tile.size
        flat = i * FAR + j
        for place in np.unique(flat):
            tile = tiles.get((int(place + FAR // 2) // FAR, int(place + FAR // 2) % FAR - FAR // 2))
            if tile is None:
                continue
            here = flat == place
            r, c = row[here] % tile.size, column[here] % tile.size
            known = (tile.elevation_mm[r, c] != UNKNOWN_ELEVATION) & (tile.sigma_mm[r, c] < UNSURE_MM)
            heights[here] = np.where(known, 0.001 * tile.elevation_mm[r, c], np.nan)
        return heights
