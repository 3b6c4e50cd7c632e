"""A cell's plane is the one its neighbours lie in, whatever its slope; cells in a line have none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.perception.local_planes import local_planes

slope = st.floats(-1.5, 1.5)


@given(slope, slope)
def test_a_plane_has_its_slope_and_no_roughness(a, b):
    x, y = np.meshgrid(np.arange(12) * 0.03, np.arange(9) * 0.03, indexing="ij")
    planes = local_planes(a * x + b * y, 0.03)
    assert planes.slope == pytest.approx(np.full((12, 9), np.arctan(np.hypot(a, b))), abs=1e-6)
    assert planes.roughness == pytest.approx(np.zeros((12, 9)), abs=1e-6)


def by_principal_axes(z, row, column, cell, radius):
    points = [
        (r * cell, c * cell, z[r, c])
        for r in range(z.shape[0])
        for c in range(z.shape[1])
        if np.hypot(r - row, c - column) * cell <= radius and np.isfinite(z[r, c])
    ]
    points = np.array(points) - np.mean(points, axis=0)
    normal = np.linalg.svd(points)[2][2]
    return np.arccos(abs(normal[2])), np.sqrt(((points @ normal) ** 2).sum() / (len(points) - 1))


def test_rough_ground_with_holes_gives_what_a_singular_value_decomposition_does():
    rng = np.random.default_rng(4)
    z = 0.02 * rng.normal(size=(20, 25)) + 0.3 * np.arange(20)[:, None] * 0.02
    z[rng.random(z.shape) < 0.2] = np.nan
    planes = local_planes(z, 0.02, radius=0.07)
    for row, column in np.argwhere(np.isfinite(z))[::17]:
        slope, roughness = by_principal_axes(z, row, column, 0.02, 0.07)
        assert planes.slope[row, column] == pytest.approx(slope, abs=1e-7)
        assert planes.roughness[row, column] == pytest.approx(roughness, abs=1e-9)


def test_unknown_cells_and_cells_in_one_line_have_no_plane():
    z = np.full((9, 9), np.nan)
    z[4, 2:7] = 0.1
    planes = local_planes(z, 0.02)
    assert np.isnan(planes.slope).all()
    assert np.isnan(planes.roughness).all()
