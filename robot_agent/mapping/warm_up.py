"""Compiles what mapping needs, so that no loop has to."""

from __future__ import annotations

import numpy as np

from robot_agent.mapping.elevation_fusion import FusionRules, fuse
from robot_agent.mapping.rolling_grid import RollingGrid
from robot_agent.mapping.sliding_features import cell_features
from robot_agent.mapping.tiles import quantised_tile, worth_sending
from weaver_shared.config.mapping import MappingConfig


def warm_up() -> None:
    """Merge a flat patch into an empty grid once and characterise it, pack a tile of it."""
    config = MappingConfig()
    grid = RollingGrid(config)
    patch = np.zeros((32, 32), dtype=np.float32)
    variance = np.full((32, 32), 1e-5, dtype=np.float32)
    rules = FusionRules(gate=3.0, slack=0.01, rejections=3, floor=0.002, drift=0.004, ceiling=0.05)
    layers = (grid.elevation, grid.variance, grid.rejected, grid.seen_ns)
    fuse(patch, variance, 0, 0, grid.row0, grid.column0, *layers, 0, rules)
    cell_features(patch, variance, config)
    tile = quantised_tile(grid, 0, 0, 0)
    worth_sending(tile, tile)
