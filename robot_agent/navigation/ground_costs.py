"""What it costs to walk over a place: from step height, roughness and slope; what is unknown costs a little more.

The map's cells are gathered into coarser ones in which a way is looked for. They are kept for as long as a goal is,
so that what the rolling map has forgotten behind the robot still counts.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robot_agent.navigation.compiled import kernel
from weaver_shared.config.navigation import RouteConfig

Array = NDArray[np.float64]
Layer = NDArray[np.float32]


class GroundMap(Protocol):
    """A rolling map: world cell (row, column) is stored at (row % size, column % size); NaN unknown."""

    @property
    def row0(self) -> int: ...
    @property
    def column0(self) -> int: ...

    size: int
    cell: float
    elevation: Layer  # (size, size) m
    roughness: Layer  # (size, size) 0..1
    slope: Layer  # (size, size) rise over run


class GroundCosts:
    """Coarse cells (rows, columns) of `cell` m; cell (r, c) spans (row0 + r) * cell .. along world x, c along y."""

    def __init__(self, config: RouteConfig, corners: Array) -> None:
        """Room for everything within `config.margin` of `corners` (n, 2), world m."""
        self._config = config
        self.cell = config.cell
        low = np.floor((corners.min(axis=0) - config.margin) / config.cell).astype(int)
        high = np.ceil((corners.max(axis=0) + config.margin) / config.cell).astype(int)
        self.row0, self.column0 = int(low[0]), int(low[1])
        shape = (int(high[0] - low[0]), int(high[1] - low[1]))
        self._lowest = np.full(shape, np.inf)
        self._highest = np.full(shape, -np.inf)
        self._roughness = np.full(shape, np.nan)
        self._slope = np.full(shape, np.nan)
        self.cost = np.full(shape, 1.0 + config.unknown_weight)
        self.blocked = np.zeros(shape, dtype=np.bool_)

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """Row and column here of world (x, y), which may lie outside."""
        return int(np.floor(x / self.cell)) - self.row0, int(np.floor(y / self.cell)) - self.column0

    def place_of(self, row: float, column: float) -> tuple[float, float]:
        """World middle of a cell, m."""
        return float((row + self.row0 + 0.5) * self.cell), float((column + self.column0 + 0.5) * self.cell)

    @property
    def known(self) -> NDArray[np.bool_]:
        seen: NDArray[np.bool_] = np.isfinite(self._highest)
        return seen

    def learn(self, ground: GroundMap) -> None:
        """Take over what the map knows now; what it no longer holds stays as it was. Then renew costs."""
        config = self._config
        _gather(
            ground.elevation,
            ground.roughness,
            ground.slope,
            ground.row0,
            ground.column0,
            ground.cell,
            self.cell,
            self.row0,
            self.column0,
            self._lowest,
            self._highest,
            self._roughness,
            self._slope,
        )
        _weigh(
            self._lowest,
            self._highest,
            self._roughness,
            self._slope,
            config.highest_step,
            config.step_weight,
            config.roughness_weight,
            config.slope_weight,
            config.unknown_weight,
            self.cost,
            self.blocked,
        )


@kernel
def _gather(
    elevation: Layer, roughness: Layer, slope: Layer, map_row0: int, map_column0: int, map_cell: float, cell: float,
    row0: int, column0: int, lowest: Array, highest: Array, rough: Array, steep: Array,
) -> None:  # fmt: skip
    size = elevation.shape[0]
    fresh = np.zeros(lowest.shape, dtype=np.bool_)
    for i in range(map_row0, map_row0 + size):
        r = int(np.floor((i + 0.5) * map_cell / cell)) - row0
        if r < 0 or r >= lowest.shape[0]:
            continue
        for j in range(map_column0, map_column0 + size):
            c = int(np.floor((j + 0.5) * map_cell / cell)) - column0
            z = elevation[i % size, j % size]
            if c < 0 or c >= lowest.shape[1] or not np.isfinite(z):
                continue
            if not fresh[r, c]:
                fresh[r, c] = True
                lowest[r, c], highest[r, c] = z, z
                rough[r, c], steep[r, c] = np.nan, np.nan
            lowest[r, c] = min(lowest[r, c], z)
            highest[r, c] = max(highest[r, c], z)
            if np.isfinite(roughness[i % size, j % size]):
                rough[r, c] = np.fmax(rough[r, c], roughness[i % size, j % size])
                steep[r, c] = np.fmax(steep[r, c], slope[i % size, j % size])


@kernel
def _weigh(
    lowest: Array, highest: Array, rough: Array, steep: Array, highest_step: float, step_weight: float,
    roughness_weight: float, slope_weight: float, unknown_weight: float, cost: Array, blocked: NDArray[np.bool_],
) -> None:  # fmt: skip
    rows, columns = lowest.shape
    for r in range(rows):
        for c in range(columns):
            blocked[r, c] = False
            if not np.isfinite(highest[r, c]):
                cost[r, c] = 1.0 + unknown_weight
                continue
            # The step is seen from the cell itself, so that the ground beside a wall is not the wall.
            step = highest[r, c] - lowest[r, c]
            for i in range(max(r - 1, 0), min(r + 2, rows)):
                for j in range(max(c - 1, 0), min(c + 2, columns)):
                    if np.isfinite(highest[i, j]):
                        step = max(step, highest[r, c] - lowest[i, j])
            blocked[r, c] = step > highest_step
            cost[r, c] = 1.0 + step_weight * (step / highest_step) ** 2
            if np.isfinite(rough[r, c]):
                cost[r, c] += roughness_weight * rough[r, c] + slope_weight * steep[r, c]
