"""A box that was taken away is forgotten once the ground behind it is seen; what is hidden or beside it stays."""

import numpy as np
import pytest
from made_ground import at, seen

from robot_agent.mapping import TerrainMap
from weaver_shared.config.mapping import MappingConfig

CAMERA = (-0.4, 0.0, 0.35)
FRAMES = MappingConfig().contradictions


def with_box(x, y):
    return np.where((np.abs(x - 0.2) < 0.05) & (np.abs(y) < 0.1), 0.15, 0.0)


def hidden_by_box(x, y):
    """Level ground as seen past the box's place from the camera: the box's own cells give no answer."""
    return np.where(with_box(x, y) > 0.0, np.nan, 0.0)


def behind_wall(x, y):
    """A wall at x = 0 that hides all beyond."""
    return np.where(x < 0.0, 0.0, np.where(x < 0.04, 0.2, np.nan))


def map_with_box():
    terrain_map = TerrainMap()
    terrain_map.update(seen(with_box, sensor=CAMERA), at())
    return terrain_map


def test_a_box_that_lines_of_sight_pass_through_is_forgotten_after_some_frames():
    terrain_map = map_with_box()
    for frame in range(FRAMES):
        assert terrain_map.elevation_at(0.2, 0.0) == pytest.approx(0.15), frame
        terrain_map.update(seen(hidden_by_box, sensor=CAMERA), at())
    assert np.isnan(terrain_map.elevation_at(0.2, 0.0))
    assert terrain_map.elevation_at(0.4, 0.0) == 0.0
    assert np.isfinite(terrain_map.grid.elevation).sum() >= 100 * 100 - 6 * 11


def test_a_box_seen_again_in_between_is_kept():
    terrain_map = map_with_box()
    for _ in range(3 * FRAMES):
        for _ in range(FRAMES - 1):
            terrain_map.update(seen(hidden_by_box, sensor=CAMERA), at())
        terrain_map.update(seen(with_box, sensor=CAMERA), at())
    assert terrain_map.elevation_at(0.2, 0.0) == pytest.approx(0.15, abs=1e-4)


def test_what_a_wall_hides_is_kept():
    terrain_map = map_with_box()
    for _ in range(3 * FRAMES):
        terrain_map.update(seen(behind_wall, sensor=CAMERA), at())
    assert terrain_map.elevation_at(0.2, 0.0) == pytest.approx(0.15)
    assert terrain_map.elevation_at(0.5, 0.3) == 0.0


def test_ground_that_simply_is_not_seen_this_time_is_kept():
    terrain_map = map_with_box()

    def far_strip(x, y):
        return np.where(x > 0.6, 0.0, np.nan)

    for _ in range(3 * FRAMES):
        terrain_map.update(seen(far_strip, sensor=CAMERA), at())
    assert terrain_map.elevation_at(-0.1, 0.0) == 0.0
    assert terrain_map.elevation_at(0.5, 0.0) == 0.0
    assert terrain_map.elevation_at(0.2, 0.0) == pytest.approx(0.15)  # a line to the strip passes over it


def test_the_features_know_that_the_box_is_gone():
    terrain_map = map_with_box()
    before = terrain_map.worst_within(0.2, 0.0, 0.2).step_height
    for _ in range(FRAMES):
        terrain_map.update(seen(hidden_by_box, sensor=CAMERA), at())
    for _ in range(3):
        terrain_map.update(seen(lambda x, y: 0.0 * x, sensor=CAMERA), at())
    assert before > 0.5
    assert terrain_map.worst_within(0.2, 0.0, 0.2).step_height < 0.02
