"""Every cell is a Kalman filter that shrugs off outliers and believes what insists."""

import numpy as np
import pytest

from robot_agent.mapping.elevation_fusion import FusionRules, fuse
from robot_agent.mapping.rolling_grid import RollingGrid
from weaver_shared.config.mapping import MappingConfig

RULES = FusionRules(gate=3.0, slack=0.01, rejections=3, floor=0.002, drift=0.0, ceiling=0.05)
SECOND = 1_000_000_000


class Cell:
    """One world cell of a map."""

    def __init__(self, rules=RULES):
        self.grid, self.rules = RollingGrid(MappingConfig()), rules

    def measure(self, z, sigma=0.005, stamp_ns=0):
        grid = self.grid
        patch, variance = np.full((1, 1), z, dtype=np.float32), np.full((1, 1), sigma**2, dtype=np.float32)
        layers = (grid.elevation, grid.variance, grid.rejected, grid.accepted, grid.seen_ns)
        return fuse(patch, variance, 3, -4, grid.row0, grid.column0, *layers, stamp_ns, self.rules)

    @property
    def height(self):
        return float(self.grid.elevation[3, -4 % self.grid.size])

    @property
    def sigma(self):
        return float(np.sqrt(self.grid.variance[3, -4 % self.grid.size]))


def test_repeated_measurements_average_and_grow_sure():
    cell, rng = Cell(), np.random.default_rng(0)
    seen = 0.1 + 0.005 * rng.normal(size=6)
    for z in seen:
        cell.measure(z)
    assert cell.height == pytest.approx(seen.mean(), abs=1e-6)
    assert cell.sigma == pytest.approx(0.005 / np.sqrt(6), rel=1e-4)


def test_no_cell_is_known_better_than_the_floor():
    cell = Cell()
    for _ in range(500):
        cell.measure(0.1)
    assert cell.sigma == pytest.approx(RULES.floor, rel=1e-4)


def test_one_outlier_changes_nothing_and_three_in_a_row_are_believed():
    cell = Cell()
    for _ in range(5):
        cell.measure(0.0)
    cell.measure(0.3)
    cell.measure(0.3)
    assert cell.height == 0.0
    cell.measure(0.0)
    for _ in range(2):
        cell.measure(0.3)
    assert cell.height == pytest.approx(0.0, abs=1e-6)
    cell.measure(0.3)
    assert cell.height == pytest.approx(0.3)


def test_a_height_seen_once_gives_way_to_the_next_and_one_seen_twice_to_two():
    cell = Cell()
    cell.measure(-0.27)
    cell.measure(0.0)
    assert cell.height == 0.0
    cell.measure(0.0)
    cell.measure(0.3)
    assert cell.height == 0.0
    cell.measure(0.3)
    assert cell.height == pytest.approx(0.3)


def test_a_cell_long_unseen_is_kept_with_a_bounded_doubt():
    cell = Cell(RULES._replace(drift=0.004))
    cell.measure(0.1)
    extent = cell.measure(0.14, stamp_ns=3600 * SECOND)
    assert extent.row_end - extent.row == 1
    gain = 0.05**2 / (0.05**2 + 0.005**2)
    assert cell.height == pytest.approx(0.1 + gain * 0.04, abs=1e-5)


def test_unknown_measurements_and_cells_outside_the_window_change_nothing():
    cell = Cell()
    extent = cell.measure(np.nan)
    assert extent.row_end <= extent.row
    grid = cell.grid
    patch = np.zeros((1, 1), dtype=np.float32)
    layers = (grid.elevation, grid.variance, grid.rejected, grid.accepted, grid.seen_ns)
    extent = fuse(patch, patch, 10_000, 0, grid.row0, grid.column0, *layers, 0, RULES)
    assert extent.row_end <= extent.row
    assert np.isnan(grid.elevation).all()
