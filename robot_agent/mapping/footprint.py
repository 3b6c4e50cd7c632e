"""The worst ground within reach of the feet (ICRA'17 Fig. 7)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.rolling_grid import RollingGrid
from weaver_shared.config.mapping import MappingConfig


@dataclass(frozen=True, slots=True, kw_only=True)
class WorstTerrain:
    """The roughest and highest of a circle, 0..1 with standard deviations; NaN where too little is known."""

    roughness: float
    roughness_sigma: float
    step_height: float
    step_height_sigma: float
    known: float  # share of the circle's cells with an answer


def worst_terrain(grid: RollingGrid, x: float, y: float, radius: float, config: MappingConfig) -> WorstTerrain:
    """Worst roughness and step height within `radius` m of world (x, y).

    The worst is a high quantile, so that one bad cell does not rule the gait; its sigma is that of the cells about as
    bad.
    """
    row, column = grid.cell_of(x, y)
    reach = math.ceil(radius / grid.cell)
    rows = np.arange(row - reach, row + reach + 1)
    columns = np.arange(column - reach, column + reach + 1)
    dx = (rows + 0.5) * grid.cell - x
    dy = (columns + 0.5) * grid.cell - y
    inside = dx[:, None] ** 2 + dy[None, :] ** 2 <= radius**2
    held = ((rows >= grid.row0) & (rows < grid.row0 + grid.size))[:, None] & (
        (columns >= grid.column0) & (columns < grid.column0 + grid.size)
    )[None, :]
    place = np.ix_(rows % grid.size, columns % grid.size)
    known = inside & held & np.isfinite(grid.roughness[place])
    share = float(known.sum()) / max(1, int(inside.sum()))
    if share < config.query_coverage:
        return WorstTerrain(
            roughness=np.nan, roughness_sigma=np.nan, step_height=np.nan, step_height_sigma=np.nan, known=share
        )
    quantile = config.query_quantile
    roughness, roughness_sigma = _worst(grid.roughness[place][known], grid.roughness_sigma[place][known], quantile)
    step, step_sigma = _worst(grid.step_height[place][known], grid.step_height_sigma[place][known], quantile)
    return WorstTerrain(
        roughness=roughness,
        roughness_sigma=roughness_sigma,
        step_height=step,
        step_height_sigma=step_sigma,
        known=share,
    )


def _worst(values: NDArray[np.float32], sigmas: NDArray[np.float32], quantile: float) -> tuple[float, float]:
    worst = float(np.quantile(values, quantile))
    return worst, float(np.median(sigmas[values >= worst]))
