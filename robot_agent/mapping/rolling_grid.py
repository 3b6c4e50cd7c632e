"""World-fixed cells in a square window that moves with the robot, tile by tile, without copying what stays."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.mapping import MappingConfig

Indices = NDArray[np.int64]


class RollingGrid:
    """Layers (size, size); world cell (row, column) is stored at (row % size, column % size).

    Row and column count cells along world x and y; cell (r, c) spans r * cell .. (r + 1) * cell. The window begins at
    tile (`tile_row`, `tile_column`); cells outside it are unknown.
    """

    def __init__(self, config: MappingConfig) -> None:
        self.cell = config.cell
        self.tile = config.tile
        self.tiles = config.tiles
        self.size = config.tile * config.tiles
        self.tile_row = -(config.tiles // 2)
        self.tile_column = -(config.tiles // 2)
        shape = (self.size, self.size)
        self.elevation = np.full(shape, np.nan, dtype=np.float32)
        self.variance = np.full(shape, np.nan, dtype=np.float32)
        self.roughness = np.full(shape, np.nan, dtype=np.float32)
        self.roughness_sigma = np.full(shape, np.nan, dtype=np.float32)
        self.step_height = np.full(shape, np.nan, dtype=np.float32)
        self.step_height_sigma = np.full(shape, np.nan, dtype=np.float32)
        self.slope = np.full(shape, np.nan, dtype=np.float32)
        self.upper = np.full(shape, np.nan, dtype=np.float32)  # highest point seen of the cell
        self.ceiling = np.full(shape, np.nan, dtype=np.float32)  # lowest thing overhead
        self.contact = np.full(shape, np.nan, dtype=np.float32)  # where a foot was borne
        self.rejected = np.zeros(shape, dtype=np.uint8)
        self.accepted = np.zeros(shape, dtype=np.uint8)  # heights that agreed with the cell's
        self.contradicted = np.zeros(shape, dtype=np.uint8)
        self.seen_ns = np.zeros(shape, dtype=np.int64)

    @property
    def _float_layers(self) -> tuple[NDArray[np.float32], ...]:
        return (
            self.elevation,
            self.variance,
            self.roughness,
            self.roughness_sigma,
            self.step_height,
            self.step_height_sigma,
            self.slope,
            self.upper,
            self.ceiling,
            self.contact,
        )

    @property
    def row0(self) -> int:
        return self.tile_row * self.tile

    @property
    def column0(self) -> int:
        return self.tile_column * self.tile

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        return math.floor(x / self.cell), math.floor(y / self.cell)

    def holds(self, row: int, column: int) -> bool:
        return 0 <= row - self.row0 < self.size and 0 <= column - self.column0 < self.size

    def recentre(self, x: float, y: float) -> None:
        """Move the window so that (x, y) lies in its middle tile; what leaves it is forgotten."""
        row, column = self.cell_of(x, y)
        tile_row = row // self.tile - self.tiles // 2
        tile_column = column // self.tile - self.tiles // 2
        for i in _entering(self.tile_row, tile_row, self.tiles):
            self._forget(self.rows_of_tile(i), slice(None))
        for j in _entering(self.tile_column, tile_column, self.tiles):
            self._forget(slice(None), self.rows_of_tile(j))
        self.tile_row, self.tile_column = tile_row, tile_column

    def rows_of_tile(self, i: int) -> slice:
        """Where a tile's rows (or columns) are stored; the window is whole tiles, so they lie together."""
        begin = (i * self.tile) % self.size
        return slice(begin, begin + self.tile)

    def slots(self, begin: int, end: int, window_begin: int) -> Indices:
        """Storage places of world rows (or columns) begin..end, cut to the window that begins at `window_begin`."""
        return np.arange(max(begin, window_begin), min(end, window_begin + self.size)) % self.size

    def clear(self) -> None:
        """Everything becomes unknown; the window stays."""
        self._forget(slice(None), slice(None))

    def _forget(self, rows: slice, columns: slice) -> None:
        for layer in self._float_layers:
            layer[rows, columns] = np.nan
        self.rejected[rows, columns] = 0
        self.accepted[rows, columns] = 0
        self.contradicted[rows, columns] = 0
        self.seen_ns[rows, columns] = 0


def _entering(old: int, new: int, tiles: int) -> range:
    """Tiles of the window that begins at `new` that the one at `old` did not have."""
    if new >= old:
        return range(max(new, old + tiles), new + tiles)
    return range(new, min(old, new + tiles))
