"""The ground's plane is found whatever stands on it, and literally in paper mode."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.perception.ground_plane import fit_plane

slope = st.floats(-0.6, 0.6)


def patch(a, b, c, rng, noise=0.0, n=1200):
    x, y = rng.uniform(0.0, 0.6, n), rng.uniform(-0.4, 0.4, n)
    return x, y, a * x + b * y + c + noise * rng.normal(size=n)


def angle_deg(a, b):
    return np.degrees(np.arccos(np.clip(a @ b, -1.0, 1.0)))


def normal_of(a, b):
    vector = np.array([-a, -b, 1.0])
    return vector / np.linalg.norm(vector)


@pytest.mark.parametrize("mode", ["robust", "paper"])
@given(a=slope, b=slope, c=st.floats(-5.0, 5.0))
def test_a_clean_plane_is_recovered_exactly(mode, a, b, c):
    plane = fit_plane(*patch(a, b, c, np.random.default_rng(0)), mode)
    assert (plane.slope_x, plane.slope_y, plane.offset) == pytest.approx((a, b, c), abs=1e-9)
    assert plane.rms < 1e-9


def test_a_box_on_a_third_of_the_ground_tilts_least_squares_and_not_the_robust_plane():
    x, y, z = patch(0.0, 0.0, 0.0, np.random.default_rng(1), noise=0.002)
    z[(x > 0.35) & (y > -0.1)] += 0.12
    up = np.array([0.0, 0.0, 1.0])
    assert angle_deg(fit_plane(x, y, z, "paper").normal, up) > 2.0
    assert angle_deg(fit_plane(x, y, z, "robust").normal, up) < 0.3


def test_on_rough_ground_both_planes_are_about_the_same():
    x, y, z = patch(0.1, 0.0, 0.0, np.random.default_rng(2), noise=0.03)
    assert angle_deg(fit_plane(x, y, z, "paper").normal, fit_plane(x, y, z, "robust").normal) < 1.0


def test_residuals_are_distances_along_the_normal():
    plane = fit_plane(*patch(1.0, 0.0, 0.0, np.random.default_rng(3)), "paper")
    residual = plane.residual(np.array([0.0]), np.array([0.0]), np.array([0.1]))
    assert residual == pytest.approx(0.1 / np.sqrt(2.0))
    assert plane.normal == pytest.approx(normal_of(1.0, 0.0))


def test_too_few_points_or_a_line_span_no_plane():
    line = np.linspace(0.0, 1.0, 20)
    with pytest.raises(ValueError, match="three points"):
        fit_plane(line[:2], line[:2], line[:2], "robust")
    with pytest.raises(ValueError, match="one line"):
        fit_plane(line, line, np.zeros(20), "robust")
