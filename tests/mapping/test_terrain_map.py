"""The map keeps what it saw, knows what it did not see, and finds the worst ground under the feet."""

from dataclasses import replace

import numpy as np
import pytest
from made_ground import at, seen

from robot_agent.mapping import TerrainMap
from robot_agent.mapping.tiles import FULL_SCALE, UNKNOWN, UNKNOWN_ELEVATION, worth_sending

SECOND = 1_000_000_000


def flat(x, y):
    return 0.0 * x


def bumpy(x, y):
    return 0.04 * np.sign(np.sin(31.4 * x)) * np.sign(np.sin(31.4 * y))


def half_bumpy(x, y):
    return np.where(x > 0.25, bumpy(x, y), 0.0)


def map_of(elevation, **where):
    terrain_map = TerrainMap()
    terrain_map.update(seen(elevation, **where), at())
    return terrain_map


def test_an_empty_map_knows_nothing():
    worst = TerrainMap().worst_within(0.0, 0.0)
    assert np.isnan([worst.roughness, worst.roughness_sigma, worst.step_height, worst.step_height_sigma]).all()
    assert worst.known == 0.0
    assert np.isnan(TerrainMap().elevation_at(0.0, 0.0))


def test_flat_ground_is_flat_and_bumpy_ground_is_rough():
    smooth, rough = (map_of(elevation).worst_within(0.0, 0.0) for elevation in (flat, bumpy))
    assert smooth.roughness < 0.05
    assert smooth.step_height < 0.05
    assert rough.roughness > 0.9
    assert rough.step_height > 0.7


def test_rough_ground_counts_once_a_tenth_of_the_circle_is_on_it():
    terrain_map = map_of(half_bumpy)
    assert terrain_map.worst_within(0.25 - 0.45 - 0.13, 0.0).roughness < 0.05
    assert terrain_map.worst_within(0.0, 0.0).roughness > 0.5


def test_a_circle_mostly_unseen_is_unknown():
    terrain_map = map_of(flat, x=(0.1, 1.0))
    assert np.isnan(terrain_map.worst_within(0.0, 0.0).roughness)
    assert terrain_map.worst_within(0.55, 0.0).roughness < 0.05
    assert np.isnan(terrain_map.worst_within(50.0, 0.0).roughness)


def test_ground_outside_the_view_is_kept_while_the_robot_walks_on():
    terrain_map = map_of(lambda x, y: 0.1 + 0.0 * x)
    terrain_map.update(seen(flat, x=(2.0, 3.0), stamp_ns=20 * SECOND), at(x=2.0))
    assert terrain_map.elevation_at(-0.5, 0.3) == pytest.approx(0.1)
    assert terrain_map.elevation_at(2.5, 0.0) == 0.0
    terrain_map.update(seen(flat, x=(9.0, 10.0), stamp_ns=40 * SECOND), at(x=9.0))
    assert np.isnan(terrain_map.elevation_at(-0.5, 0.3))


def test_changed_tiles_carry_the_map_once():
    terrain_map = map_of(half_bumpy)
    tiles = terrain_map.changed_tiles(3 * SECOND)
    assert terrain_map.changed_tiles(3 * SECOND) == []
    cells = 0
    for tile in tiles:
        known = tile.elevation_mm != UNKNOWN_ELEVATION
        rows, columns = np.nonzero(known)
        x = (tile.i * tile.size + rows + 0.5) * tile.cell
        y = (tile.j * tile.size + columns + 0.5) * tile.cell
        assert tile.elevation_mm[known] == pytest.approx(np.rint(1000 * half_bumpy(x, y)), abs=1)
        assert (tile.sigma_mm[known] == 3).all()
        assert (tile.age_s[known] == 3).all()
        assert (tile.age_s[~known] == UNKNOWN).all()
        assert tile.roughness[tile.roughness != UNKNOWN].max(initial=0) <= FULL_SCALE
        cells += int(known.sum())
    assert cells == 100 * 100


def test_ground_that_looks_as_before_is_not_sent_again():
    terrain_map = map_of(flat)
    assert terrain_map.changed_tiles(0)
    terrain_map.update(seen(flat, x=(0.3, 0.4), y=(0.3, 0.4), stamp_ns=SECOND), at())
    assert terrain_map.changed_tiles(SECOND) == []


@pytest.mark.parametrize(
    ("layer", "change", "sent"),
    [("elevation_mm", 3, False), ("elevation_mm", 4, True), ("roughness", 10, False), ("step_height", 11, True)],
)
def test_a_tile_is_sent_again_when_it_differs_by_more_than_noise(layer, change, sent):
    tile = map_of(flat).changed_tiles(0)[0]
    values = getattr(tile, layer).copy()
    values[values != (UNKNOWN_ELEVATION if layer == "elevation_mm" else UNKNOWN)] += change
    assert worth_sending(replace(tile, **{layer: values}), tile) is sent


def test_a_cell_that_becomes_known_is_always_sent():
    tile = map_of(flat).changed_tiles(0)[0]
    forgotten = tile.elevation_mm.copy()
    forgotten[tuple(np.argwhere(forgotten != UNKNOWN_ELEVATION)[0])] = UNKNOWN_ELEVATION
    assert worth_sending(tile, replace(tile, elevation_mm=forgotten))
    assert worth_sending(tile, None)


def test_features_do_not_depend_on_how_the_ground_came_in():
    whole, parts = map_of(bumpy), TerrainMap()
    for left in np.arange(-1.0, 1.0, 0.2):
        parts.update(seen(bumpy, x=(left, left + 0.2)), at())
    for name in ("elevation", "roughness", "step_height", "slope"):
        # Running sums start from different places, so they round differently.
        np.testing.assert_allclose(getattr(whole.grid, name), getattr(parts.grid, name), atol=2e-5, err_msg=name)


def test_cells_of_another_size_are_refused():
    with pytest.raises(ValueError, match=r"0\.05 m"):
        TerrainMap().update(seen(flat, cell=0.05), at())
