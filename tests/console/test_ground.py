"""Heights of the console's map and where a line of sight meets it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from wire_robot import ground_height, ground_tile

from weaver_console.scene.ground import UNKNOWN_MM, Ground
from weaver_shared.messages import MapTile

CELL = 0.02


def _ground(reach: int = 2) -> Ground:
    ground = Ground()
    for i in range(-reach, reach):
        for j in range(-reach, reach):
            ground.put(ground_tile(i, j))
    return ground


GRID = _ground().grid()
inside = st.floats(-1.2, 1.15)
above = st.floats(0.4, 5.0)


def _flat(tile: MapTile, height_mm: int, known: np.ndarray) -> MapTile:
    elevation = np.where(known, height_mm, UNKNOWN_MM).astype(np.int16)
    layer = np.zeros((tile.size, tile.size), dtype=np.uint8)
    return MapTile(
        stamp_ns=1, i=tile.i, j=tile.j, size=tile.size, cell=tile.cell, elevation_mm=elevation, sigma_mm=layer,
        roughness=layer, step_height=layer, age_s=layer,
    )  # fmt: skip


@given(x=inside, y=inside, eye_x=st.floats(-4.0, 4.0), eye_y=st.floats(-4.0, 4.0), eye_z=above)
def test_a_ray_towards_a_place_on_smooth_ground_meets_the_ground_there_or_before(x, y, eye_x, eye_y, eye_z):
    target = np.array([x, y, float(ground_height(np.array([x]), np.array([y]))[0])])
    eye = np.array([eye_x, eye_y, eye_z])
    met = GRID.meet(eye, (target - eye) / np.linalg.norm(target - eye))
    assert met is not None
    height = GRID.heights(met[:1], met[1:2])[0]
    assert abs(met[2] - height) < 0.01
    assert np.linalg.norm(met - eye) <= np.linalg.norm(target - eye) + 2.0 * CELL


@given(x=inside, y=inside)
def test_a_ray_straight_down_meets_the_ground_below(x, y):
    met = GRID.meet(np.array([x, y, 3.0]), np.array([0.0, 0.0, -1.0]))
    assert met is not None
    assert np.allclose(met[:2], (x, y), atol=1e-9)
    assert met[2] == pytest.approx(GRID.heights(np.array([x]), np.array([y]))[0], abs=1e-6)


@given(x=inside, y=inside, up=st.floats(0.0, 1.0), heading=st.floats(-np.pi, np.pi))
def test_a_ray_upwards_meets_nothing(x, y, up, heading):
    assert GRID.meet(np.array([x, y, 1.0]), np.array([np.cos(heading), np.sin(heading), up])) is None


def test_a_ray_past_the_map_meets_nothing():
    assert GRID.meet(np.array([9.0, 0.0, 1.0]), np.array([0.0, 0.0, -1.0])) is None


def test_unknown_ground_is_looked_through_to_what_lies_behind():
    blank = ground_tile(0, 0)
    known = np.zeros((32, 32), dtype=bool)
    known[20:, :] = True
    ground = Ground()
    ground.put(_flat(blank, 0, known))
    grid = ground.grid()
    hole = np.array([5.5 * CELL, 0.3, 1.0])
    assert grid.meet(hole, np.array([0.0, 0.0, -1.0])) is None
    assert grid.meet(np.array([0.0, 0.3, 1.0]), np.array([0.5, 0.0, -1.0]))[0] == pytest.approx(0.5, abs=0.02)


def test_nothing_known_is_met_by_nothing():
    ground = Ground()
    assert ground.grid() is None
    ground.put(_flat(ground_tile(0, 0), 0, np.zeros((32, 32), dtype=bool)))
    assert ground.grid().meet(np.array([0.1, 0.1, 1.0]), np.array([0.0, 0.0, -1.0])) is None
    assert ground.range() is None


@given(x=inside, y=inside)
def test_heights_are_those_of_the_tile_on_both_sides_of_the_origin(x, y):
    ground = _GROUND
    row, column = np.floor(x / CELL), np.floor(y / CELL)
    centre = np.array([(row + 0.5) * CELL]), np.array([(column + 0.5) * CELL])
    assert ground.height(x, y) == pytest.approx(float(ground_height(*centre)[0]), abs=0.00051)


_GROUND = _ground()


def test_a_height_off_the_map_is_not_a_number():
    assert np.isnan(_GROUND.height(100.0, 0.0))
    assert np.isnan(_GROUND.height(float("nan"), 0.0))
    assert np.isnan(Ground().height(0.0, 0.0))
