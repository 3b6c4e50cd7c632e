"""The terrain map as the console has it: tiles, heights between cells, and where a line of sight meets the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import count, takewhile

import numpy as np
from numpy.typing import NDArray

from weaver_shared.messages import MapTile

Array = NDArray[np.float64]
TileIndex = tuple[int, int]

UNKNOWN_MM = -32768
EDGE_DEPTH = 0.05
"""How far below the first known cell behind unknown ground a ray may enter and still count as meeting it, m."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HeightGrid:
    """Heights of a rectangle of cells, NaN where unknown; cell (0, 0) is centred at `origin` (m)."""

    elevation: Array  # (rows along x, columns along y) m
    origin: tuple[float, float]
    cell: float

    def heights(self, x: Array, y: Array) -> Array:
        """Bilinear heights at points (n,); the nearest cell's where a neighbour is unknown, NaN where it is too."""
        row, column = (x - self.origin[0]) / self.cell, (y - self.origin[1]) / self.cell
        nearest = self._at(np.rint(row).astype(int), np.rint(column).astype(int))
        r0, c0 = np.floor(row).astype(int), np.floor(column).astype(int)
        fr, fc = row - r0, column - c0
        near = self._at(r0, c0) * (1 - fc) + self._at(r0, c0 + 1) * fc
        far = self._at(r0 + 1, c0) * (1 - fc) + self._at(r0 + 1, c0 + 1) * fc
        blended = near * (1 - fr) + far * fr
        return np.where(np.isfinite(blended), blended, nearest)

    def _at(self, row: NDArray[np.int_], column: NDArray[np.int_]) -> Array:
        rows, columns = self.elevation.shape
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        value = self.elevation[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]
        return np.where(inside, value, np.nan)

    def meet(self, origin: Array, direction: Array) -> Array | None:
        """First point (3,) where the ray meets the ground from above, within half a cell; None if it does not."""
        span = self._clip(origin, direction)
        if span is None:
            return None
        length = float(np.linalg.norm(direction))
        samples = max(2, int(np.ceil((span[1] - span[0]) * length / (0.5 * self.cell))) + 1)
        along = np.linspace(span[0], span[1], samples)
        points = origin + along[:, None] * direction
        above = points[:, 2] - self.heights(points[:, 0], points[:, 1])
        return _first_crossing(points, above)

    def _clip(self, origin: Array, direction: Array) -> tuple[float, float] | None:
        """Interval of the ray inside the box of known ground."""
        if not np.isfinite(self.elevation).any():
            return None
        size = np.array(self.elevation.shape) * self.cell
        low = np.array([*self.origin, float(np.nanmin(self.elevation)) - EDGE_DEPTH]) - [*[0.5 * self.cell] * 2, 0.0]
        high = np.array([*(low[:2] + size), float(np.nanmax(self.elevation)) + EDGE_DEPTH])
        start, end = 0.0, np.inf
        for axis in range(3):
            if abs(direction[axis]) < 1e-12:
                if not low[axis] <= origin[axis] <= high[axis]:
                    return None
                continue
            bounds = sorted(((b - origin[axis]) / direction[axis]) for b in (low[axis], high[axis]))
            start, end = max(start, bounds[0]), min(end, bounds[1])
        return (start, end) if start < end < np.inf else None


def _first_crossing(points: Array, above: Array) -> Array | None:
    known = np.isfinite(above)
    previous = np.concatenate([[np.nan], above[:-1]])
    crossing = known & (above <= 0.0) & ((previous > 0.0) | (~np.isfinite(previous) & (above > -EDGE_DEPTH)))
    if not crossing.any():
        return None
    index = int(np.argmax(crossing))
    if not np.isfinite(previous[index]):
        return np.asarray(points[index])
    share = previous[index] / (previous[index] - above[index])
    return np.asarray(points[index - 1] + share * (points[index] - points[index - 1]))


_serials = count(1)


class Ground:
    """Newest tile of each place. One writer; readers take whole tiles, which never change."""

    def __init__(self) -> None:
        self.serial = next(_serials)  # tells one robot's ground from another's for as long as the program runs
        self.tiles: dict[TileIndex, MapTile] = {}
        self.versions: dict[TileIndex, int] = {}
        self.version = 0
        self._order: dict[TileIndex, None] = {}  # those changed last come last
        self._ranges: dict[TileIndex, tuple[int, int]] = {}  # mm, of the tiles in which something is known

    def put(self, tile: MapTile) -> None:
        index = (tile.i, tile.j)
        self.version += 1
        self.tiles[index] = tile
        self.versions[index] = self.version
        self._order.pop(index, None)
        self._order[index] = None
        known = tile.elevation_mm[tile.elevation_mm != UNKNOWN_MM]
        if known.size:
            self._ranges[index] = (int(known.min()), int(known.max()))
        else:
            self._ranges.pop(index, None)

    def changed_since(self, version: int) -> list[TileIndex]:
        """Places of the tiles that are newer than this version."""
        return list(takewhile(lambda index: self.versions[index] > version, reversed(list(self._order))))

    def grid(self) -> HeightGrid | None:
        """All tiles as one grid; None before the first. Tiles of another size or cell than the newest are left out."""
        tiles = list(self.tiles.values())
        if not tiles:
            return None
        size, cell = tiles[-1].size, tiles[-1].cell
        tiles = [t for t in tiles if t.size == size and t.cell == cell]
        i0, j0 = min(t.i for t in tiles), min(t.j for t in tiles)
        rows, columns = max(t.i for t in tiles) - i0 + 1, max(t.j for t in tiles) - j0 + 1
        elevation = np.full((rows * size, columns * size), np.nan)
        for tile in tiles:
            r, c = (tile.i - i0) * size, (tile.j - j0) * size
            elevation[r : r + size, c : c + size] = elevation_of(tile)
        return HeightGrid(elevation=elevation, origin=((i0 * size + 0.5) * cell, (j0 * size + 0.5) * cell), cell=cell)

    def height(self, x: float, y: float) -> float:
        """Height at a place in m, NaN where unknown."""
        tile = next(iter(self.tiles.values()), None)
        if tile is None or not (math.isfinite(x) and math.isfinite(y)):
            return float("nan")
        row, column = math.floor(x / tile.cell), math.floor(y / tile.cell)
        place = self.tiles.get((row // tile.size, column // tile.size))
        if place is None or place.cell != tile.cell or place.size != tile.size:
            return float("nan")
        height_mm = int(place.elevation_mm[row % tile.size, column % tile.size])
        return float("nan") if height_mm == UNKNOWN_MM else height_mm * 1e-3

    def range(self) -> tuple[float, float] | None:
        """Lowest and highest known height in m."""
        ranges = list(self._ranges.values())
        if not ranges:
            return None
        return min(low for low, _ in ranges) * 1e-3, max(high for _, high in ranges) * 1e-3


def elevation_of(tile: MapTile) -> Array:
    """Heights (size, size) in m, NaN where unknown."""
    return np.where(tile.elevation_mm == UNKNOWN_MM, np.nan, tile.elevation_mm * 1e-3)
