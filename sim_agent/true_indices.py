"""Roughness and step height of a world as they truly are, by the definitions the robot's map uses (eqs. 7 and 8)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.sliding_features import cell_features
from sim_agent.worlds import World
from weaver_shared.config.mapping import MappingConfig

Array = NDArray[np.float64]

SAMPLES = 5  # along each edge of a cell: the map keeps a cell's top, so the truth's top is sought too


def cell_tops(world: World, x: Array, y: Array, cell: float) -> Array:
    """Highest true elevation (m) of every cell (len(x), len(y)) given by its centres."""
    offsets = ((np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5) * cell
    top = np.full((len(x), len(y)), -np.inf)
    for dx in offsets:
        for dy in offsets:
            top = np.maximum(top, world.elevation((x + dx)[:, None], (y + dy)[None, :]))
    return top


def worst_along(world: World, places: Array, config: MappingConfig = MappingConfig()) -> Array:  # noqa: B008
    """Roughness and step height (n, 2) that rule the gait of a body at `places` (n,), m along the x axis.

    As `worst_within` asks the map: the quantile of the circle under the feet, here of the true surface.
    """
    reach, rim = config.query_radius, (config.window // 2 + 1) * config.cell
    x = np.arange(places.min() - reach - rim, places.max() + reach + rim, config.cell)
    y = np.arange(-reach - rim, reach + rim, config.cell)
    top = cell_tops(world, x, y, config.cell).astype(np.float32)
    features = cell_features(top, np.zeros_like(top), config)
    result = np.empty((len(places), 2))
    for k, place in enumerate(places):
        inside = (x[:, None] - place) ** 2 + y[None, :] ** 2 <= reach**2
        layers = (features.roughness[inside], features.step_height[inside])
        result[k] = [np.quantile(layer, config.query_quantile) for layer in layers]
    return result
