"""The map at one moment, laid out plainly: rows along world x, columns along world y."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.rolling_grid import RollingGrid

Layer = NDArray[np.float32]

LAYERS: dict[str, str] = {
    "elevation": "m",
    "variance": "m^2",
    "upper": "m",
    "ceiling": "m",
    "contact": "m",
    "roughness": "",
    "roughness_sigma": "",
    "step_height": "",
    "step_height_sigma": "",
    "slope": "rise over run",
}
"""Units of the layers that files carry, NaN unknown. Roughness and step height are indices, 0 to 1."""


WELL_KNOWN = 255
"""Sightings that a cell from a file is taken to have had."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapSnapshot:
    """World cells from (row0, column0) on: cell (r, c) is centred at ((row0 + r + 0.5) * cell, ...) in world, m."""

    row0: int
    column0: int
    cell: float  # m
    layers: dict[str, Layer]  # (rows, columns) each
    seen_ns: NDArray[np.int64]  # (rows, columns) when a cell was last seen, 0 never

    @staticmethod
    def of(grid: RollingGrid) -> MapSnapshot:
        """What `grid` knows, cut to the smallest rectangle of tiles that holds it."""
        rows = np.arange(grid.row0, grid.row0 + grid.size)
        columns = np.arange(grid.column0, grid.column0 + grid.size)
        stored = np.ix_(rows % grid.size, columns % grid.size)
        known = np.isfinite(grid.elevation[stored]) | np.isfinite(grid.contact[stored])
        begin_row, end_row = _tiles_about(np.any(known, axis=1), grid.tile)
        begin_column, end_column = _tiles_about(np.any(known, axis=0), grid.tile)
        part = (slice(begin_row, end_row), slice(begin_column, end_column))
        return MapSnapshot(
            row0=int(rows[0]) + begin_row,
            column0=int(columns[0]) + begin_column,
            cell=grid.cell,
            layers={name: getattr(grid, name)[stored][part].copy() for name in LAYERS},
            seen_ns=grid.seen_ns[stored][part].copy(),
        )

    def enter(self, grid: RollingGrid) -> None:
        """Put what lies in the grid's window there, over what it knew. Raises ValueError on cells of another size."""
        if not np.isclose(self.cell, grid.cell):
            raise ValueError(f"the file's cells are {self.cell} m wide, the map's {grid.cell} m")
        known = np.isfinite(self.layers["elevation"]) | np.isfinite(self.layers["contact"])
        rows, columns = (index.astype(np.int64) for index in np.nonzero(known))
        held = (self.row0 + rows >= grid.row0) & (self.row0 + rows < grid.row0 + grid.size)
        held &= (self.column0 + columns >= grid.column0) & (self.column0 + columns < grid.column0 + grid.size)
        rows, columns = rows[held], columns[held]
        stored = (self.row0 + rows) % grid.size, (self.column0 + columns) % grid.size
        for name, layer in self.layers.items():
            getattr(grid, name)[stored] = layer[rows, columns]
        grid.seen_ns[stored], grid.accepted[stored] = self.seen_ns[rows, columns], WELL_KNOWN

    @property
    def shape(self) -> tuple[int, int]:
        rows, columns = self.seen_ns.shape
        return rows, columns

    @property
    def corner(self) -> tuple[float, float]:
        """World x, y in m of the corner of cell (0, 0) that is lowest in both."""
        return self.row0 * self.cell, self.column0 * self.cell


def _tiles_about(known: NDArray[np.bool_], tile: int) -> tuple[int, int]:
    """First and last (exclusive) index of the whole tiles that hold all that is known; one tile if nothing is."""
    if not known.any():
        return 0, tile
    places = np.flatnonzero(known)
    return int(places[0]) // tile * tile, (int(places[-1]) // tile + 1) * tile
