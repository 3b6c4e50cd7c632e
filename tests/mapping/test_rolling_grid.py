"""The window moves with the robot; what stays in it is kept where it was, what leaves it is forgotten."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.mapping.rolling_grid import RollingGrid
from weaver_shared.config.mapping import MappingConfig

CONFIG = MappingConfig(tiles=5, tile=8, cell=0.1)
metre = st.floats(-30.0, 30.0)


def mark(grid, x, y, value):
    row, column = grid.cell_of(x, y)
    grid.elevation[row % grid.size, column % grid.size] = value
    return row, column


def read(grid, cell):
    row, column = cell
    return grid.elevation[row % grid.size, column % grid.size] if grid.holds(row, column) else np.nan


@given(metre, metre, st.lists(st.tuples(metre, metre), max_size=6))
def test_a_cell_is_remembered_exactly_while_it_stays_in_the_window(x, y, way):
    grid = RollingGrid(CONFIG)
    grid.recentre(x, y)
    cell = mark(grid, x, y, 7.0)
    kept = True
    for place in way:
        grid.recentre(*place)
        kept = kept and grid.holds(*cell)
        assert (read(grid, cell) == 7.0) == kept
    assert int(np.isfinite(grid.elevation).sum()) == int(kept)


@given(metre, metre)
def test_the_robot_stands_in_the_middle_tile(x, y):
    grid = RollingGrid(CONFIG)
    grid.recentre(x, y)
    row, column = grid.cell_of(x, y)
    for index, begin in ((row, grid.row0), (column, grid.column0)):
        assert 2 * grid.tile <= index - begin < 3 * grid.tile


def test_the_shipped_window_reaches_three_metres_to_every_side():
    grid = RollingGrid(MappingConfig())
    for x in (0.0, 0.639, -0.01):
        grid.recentre(x, 0.0)
        for far in (x - 3.0, x + 3.0):
            assert grid.holds(*grid.cell_of(far, 0.0))
