"""The upper bound is the highest point seen, and comes down only slowly; the ceiling is what hangs overhead."""

import numpy as np
import pytest
from made_ground import at, seen

from robot_agent.mapping import TerrainMap


def layer_at(terrain_map, layer, x=0.1, y=0.1):
    grid = terrain_map.grid
    row, column = grid.cell_of(x, y)
    return float(getattr(grid, layer)[row % grid.size, column % grid.size])


def frame(top=0.0, overhead=np.nan):
    perceived = seen(lambda x, y: 0.0 * x)
    perceived.grid.upper = np.full_like(perceived.grid.elevation, top)
    perceived.grid.ceiling = np.full_like(perceived.grid.elevation, overhead)
    return perceived


def test_the_upper_bound_rises_at_once_and_sinks_slowly():
    terrain_map = TerrainMap()
    for top, expected in [(0.01, 0.01), (0.05, 0.05), (0.0, 0.04), (0.0, 0.032), (0.06, 0.06)]:
        terrain_map.update(frame(top), at())
        assert layer_at(terrain_map, "upper") == pytest.approx(expected, abs=1e-6)


def test_the_upper_bound_is_never_under_the_elevation():
    terrain_map = TerrainMap()
    terrain_map.update(frame(-0.2), at())
    assert layer_at(terrain_map, "upper") == layer_at(terrain_map, "elevation") == 0.0


def test_the_ceiling_is_unknown_until_something_hangs_there():
    terrain_map = TerrainMap()
    terrain_map.update(frame(), at())
    assert np.isnan(layer_at(terrain_map, "ceiling"))
    terrain_map.update(frame(overhead=0.6), at())
    terrain_map.update(frame(), at())
    assert layer_at(terrain_map, "ceiling") == pytest.approx(0.6)
