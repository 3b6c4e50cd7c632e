"""A foothold makes ground known, agrees with what is seen, and tells of grass where it does not."""

import numpy as np
import pytest
from made_ground import at, seen

from robot_agent.mapping import TerrainMap


def grown_map(height):
    terrain_map = TerrainMap()
    terrain_map.update(seen(lambda x, y: height + 0.0 * x, sigma=0.006), at())
    return terrain_map


def contact_at(terrain_map, x, y):
    grid = terrain_map.grid
    row, column = grid.cell_of(x, y)
    return float(grid.contact[row % grid.size, column % grid.size])


def test_unseen_ground_is_known_where_a_foot_stands():
    terrain_map = TerrainMap()
    terrain_map.touch(np.array([[0.31, -0.2, 0.07]]), 0)
    assert terrain_map.elevation_at(0.31, -0.2) == pytest.approx(0.07)
    assert contact_at(terrain_map, 0.31, -0.2) == pytest.approx(0.07)
    assert np.isnan(terrain_map.elevation_at(0.36, -0.2))


def test_a_foothold_near_the_seen_height_is_weighed_with_it():
    terrain_map = grown_map(0.01)
    terrain_map.touch(np.array([[0.31, -0.2, 0.0]]), 0)
    weight = 0.006**2 / (0.006**2 + 0.008**2)
    assert terrain_map.elevation_at(0.31, -0.2) == pytest.approx(0.01 * (1.0 - weight), abs=1e-5)


def test_grass_looks_higher_than_it_bears_and_the_map_says_by_how_much():
    terrain_map = grown_map(0.06)
    for x in np.linspace(-0.5, 0.5, 8):
        terrain_map.touch(np.array([[x, 0.1, 0.002], [x, -0.1, -0.002]]), 0)
    assert terrain_map.elevation_at(0.5, 0.1) == pytest.approx(0.06)  # as seen
    assert contact_at(terrain_map, 0.5, 0.1) == pytest.approx(0.002)  # as it bears
    cover = terrain_map.cover
    assert cover.footholds == 16
    assert cover.height == pytest.approx(0.06, abs=0.003)
    assert cover.spread < 0.005


def test_nothing_is_said_of_a_cover_from_a_few_feet_or_on_unseen_ground():
    terrain_map = grown_map(0.06)
    terrain_map.touch(np.array([[0.0, 0.1, 0.0]]), 0)
    assert np.isnan(terrain_map.cover.height)
    unseen = TerrainMap()
    unseen.touch(np.tile([0.1, 0.1, 0.0], (1, 1)), 0)
    assert unseen.cover.footholds == 0


def test_impossible_footholds_and_those_outside_the_window_are_left_out():
    terrain_map = TerrainMap()
    terrain_map.touch(np.array([[np.nan, 0.0, 0.0], [0.0, np.inf, 0.0], [90.0, 0.0, 0.0]]), 0)
    assert np.isnan(terrain_map.grid.elevation).all()
    terrain_map.touch(np.zeros((0, 3)), 0)
