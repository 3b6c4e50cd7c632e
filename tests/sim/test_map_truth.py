"""A map equal to the ground has no error; one with its stated noise is covered as stated."""

from dataclasses import replace

import numpy as np
import pytest

from robot_agent.mapping import TerrainMap
from robot_agent.mapping.files import MapSnapshot
from sim_agent.map_truth import compare, rank_correlation
from sim_agent.worlds import make_world
from weaver_shared.config.mapping import MappingConfig

CONFIG = MappingConfig()
WORLD = make_world("testbed", 1)


def mapped(noise=0.0, begin=1.8, end=5.2, seed=0):
    """The true tops of the course from `begin` to `end` m, entered with `noise` (m)."""
    terrain_map, rng = TerrainMap(), np.random.default_rng(seed)
    grid = terrain_map.grid
    grid.recentre(0.5 * (begin + end), 0.0)
    rows = np.arange(round(begin / grid.cell), round(end / grid.cell))
    columns = np.arange(-25, 25)
    offsets = ((np.arange(5) + 0.5) / 5 - 0.5) * grid.cell
    x, y = (rows + 0.5) * grid.cell, (columns + 0.5) * grid.cell
    tops = np.max([WORLD.elevation((x + dx)[:, None], (y + dy)[None, :]) for dx in offsets for dy in offsets], axis=0)
    place = np.ix_(rows % grid.size, columns % grid.size)
    grid.elevation[place] = tops + noise * rng.normal(size=tops.shape)
    grid.variance[place] = max(noise, 1e-3) ** 2
    terrain_map.renew_all()
    return terrain_map.snapshot()


def test_a_perfect_map_has_no_error_and_ranks_the_segments_right():
    # The features at the map's rim see less ground than the truth's: only the inner cells are alike.
    found = compare(mapped(), WORLD, CONFIG)
    assert {"A", "B", "C", "D"} <= set(found)
    for segment in found.values():
        assert segment.elevation.mean_absolute_error < 1e-6
        assert segment.roughness.mean_absolute_error < 0.05
        assert segment.roughness.within_two_sigma > 0.8
    assert rank_correlation(found, "roughness") > 0.9
    assert found["C"].roughness.true_level > found["A"].roughness.true_level


def test_stated_noise_is_covered_as_stated():
    found = compare(mapped(noise=0.004), WORLD, CONFIG)["A"].elevation
    assert found.mean_absolute_error == pytest.approx(0.004 * 0.798, rel=0.1)
    assert found.within_one_sigma == pytest.approx(0.68, abs=0.05)
    assert found.within_two_sigma == pytest.approx(0.95, abs=0.03)


def test_a_map_too_sure_of_itself_is_found_out():
    snapshot: MapSnapshot = mapped(noise=0.01)
    sure = replace(snapshot, layers=snapshot.layers | {"variance": np.full(snapshot.shape, 1e-6, dtype=np.float32)})
    assert compare(sure, WORLD, CONFIG)["A"].elevation.within_two_sigma < 0.3


def test_segments_hardly_seen_are_left_out():
    assert "C" not in compare(mapped(begin=1.0, end=2.0), WORLD, CONFIG)
