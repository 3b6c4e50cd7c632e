"""Compiles what mapping needs, so that no loop has to."""

from __future__ import annotations

import numpy as np

from robot_agent.mapping.bounds import renew_bounds
from robot_agent.mapping.deformation import deform
from robot_agent.mapping.elevation_fusion import FusionRules, fuse
from robot_agent.mapping.footholds import Footholds
from robot_agent.mapping.rolling_grid import RollingGrid
from robot_agent.mapping.sliding_features import cell_features
from robot_agent.mapping.tiles import quantised_tile, worth_sending
from robot_agent.mapping.visibility import forget_contradicted
from weaver_shared.config.mapping import MappingConfig
from weaver_shared.transforms import Pose


def warm_up() -> None:
    """Merge a flat patch into an empty grid once, look through it, tread on it, shift it and pack a tile of it."""
    config = MappingConfig()
    grid = RollingGrid(config)
    patch = np.zeros((32, 32), dtype=np.float32)
    variance = np.full((32, 32), 1e-5, dtype=np.float32)
    rules = FusionRules(gate=3.0, slack=0.01, rejections=3, floor=0.002, drift=0.004, ceiling=0.05)
    place = (0, 0, grid.row0, grid.column0)
    counts = (grid.rejected, grid.accepted)
    fuse(patch, variance, *place, grid.elevation, grid.variance, *counts, grid.seen_ns, 0, rules)
    renew_bounds(patch, patch, *place, grid.elevation, grid.upper, grid.ceiling, config.upper_decay)
    layers = (grid.elevation, grid.variance, grid.upper, grid.contradicted)
    sensor = np.array([0.0, 0.0, 0.3])
    forget_contradicted(patch, *place, grid.cell, sensor, *layers, config.ray_clearance, config.contradictions)
    Footholds(config.contact_sigma).enter(grid, np.array([[0.1, 0.1, 0.0]]), 0, rules)
    deform(grid, np.zeros(1, dtype=np.int64), [Pose.of([0.1, 0.0, 0.0])])
    cell_features(patch, variance, config)
    tile = quantised_tile(grid, 0, 0, 0)
    worth_sending(tile, tile)
