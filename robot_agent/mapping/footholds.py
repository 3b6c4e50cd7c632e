"""Feet as measuring rods: where one was borne the ground is known, whatever grew or lay on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.elevation_fusion import Extent, FusionRules, fuse, joined
from robot_agent.mapping.rolling_grid import RollingGrid

Array = NDArray[np.float64]

SOLE = 0.02  # m about the point of contact that the foot has felt
REMEMBERED = 30  # footholds about that the cover is told of
FEWEST = 6  # footholds without which nothing is said of a cover


@dataclass(frozen=True, slots=True, kw_only=True)
class Cover:
    """How much higher the ground looks than it bears, m: grass and sand above, odometry's drift either way."""

    height: float  # median, NaN as long as too few feet have stood on seen ground
    spread: float  # m, half of the middle 68 %
    footholds: int


class Footholds:
    """Enters footholds into the map and compares them with what the cameras said of the same places."""

    def __init__(self, sigma: float) -> None:
        self._sigma = sigma
        self._seen_above: list[float] = []

    def enter(self, grid: RollingGrid, footholds: Array, stamp_ns: int, rules: FusionRules) -> Extent | None:
        """Enter points of support (k, 3) in world, m, felt at `stamp_ns`; returns the cells whose elevation changed.

        The contact layer keeps every foothold. The elevation takes it as one more measurement, which ground that
        looks far higher or lower does not accept: there the cameras and the feet go on disagreeing, in sight.
        """
        changed: Extent | None = None
        for x, y, z in footholds[np.isfinite(footholds).all(axis=1)]:
            row, column = grid.cell_of(x, y)
            if not grid.holds(row, column):
                continue
            seen = float(grid.elevation[row % grid.size, column % grid.size])
            if np.isfinite(seen):
                self._seen_above.append(seen - z)
                del self._seen_above[:-REMEMBERED]
            extent = self._press(grid, row, column, float(x), float(y), float(z), stamp_ns, rules)
            changed = extent if changed is None else joined(changed, extent)
        return changed

    @property
    def cover(self) -> Cover:
        if len(self._seen_above) < FEWEST:
            return Cover(height=np.nan, spread=np.nan, footholds=len(self._seen_above))
        low, median, high = np.quantile(self._seen_above, [0.16, 0.5, 0.84])
        return Cover(height=float(median), spread=0.5 * float(high - low), footholds=len(self._seen_above))

    def _press(
        self, grid: RollingGrid, row: int, column: int, x: float, y: float, z: float, stamp_ns: int, rules: FusionRules
    ) -> Extent:
        """Level ground at `z` for the cells under the sole."""
        reach = int(np.ceil(SOLE / grid.cell))
        offset = np.arange(-reach, reach + 1)
        dx, dy = ((row + offset + 0.5) * grid.cell - x)[:, None], ((column + offset + 0.5) * grid.cell - y)[None, :]
        under = (dx**2 + dy**2 <= SOLE**2) | ((offset[:, None] == 0) & (offset[None, :] == 0))
        patch = np.where(under, z, np.nan).astype(np.float32)
        variance = np.full(patch.shape, self._sigma**2, dtype=np.float32)
        stored = np.ix_((row + offset) % grid.size, (column + offset) % grid.size)
        held_rows = (row + offset >= grid.row0) & (row + offset < grid.row0 + grid.size)
        held_columns = (column + offset >= grid.column0) & (column + offset < grid.column0 + grid.size)
        pressed = under & held_rows[:, None] & held_columns[None, :]
        grid.contact[stored] = np.where(pressed, np.float32(z), grid.contact[stored])
        # What a single foot says against the pictures is left to the contact layer.
        rejected, accepted = np.zeros_like(grid.rejected), np.maximum(grid.accepted, 2)
        grid.accepted[stored] = np.where(pressed, np.maximum(grid.accepted[stored], 1), grid.accepted[stored])
        extent: Extent = fuse(
            patch,
            variance,
            row - reach,
            column - reach,
            grid.row0,
            grid.column0,
            grid.elevation,
            grid.variance,
            rejected,
            accepted,
            grid.seen_ns,
            stamp_ns,
            rules,
        )
        return extent
