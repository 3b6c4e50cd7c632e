"""The lens kernels against the plain form and against differences."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.calibration.lens import MODELS, camera_of, project_points
from robot_agent.vision.distortion import normalise, project

LENSES = {
    "none": np.zeros(4),
    "radtan": np.array([-0.28, 0.07, 2e-4, -1e-4]),
    "equidistant": np.array([0.04, -0.02, 0.005, -0.001]),
}


def intrinsics(model: str) -> np.ndarray:
    return np.concatenate([[460.0, 455.0, 318.0, 243.0], LENSES[model]])


@pytest.mark.parametrize("model", MODELS)
@given(st.integers(0, 1000))
def test_pixels_lead_to_rays_and_back(model: str, seed: int) -> None:
    camera = camera_of(model, intrinsics(model), (640, 480))
    pixels = np.random.default_rng(seed).uniform((0.0, 0.0), (639.0, 479.0), (20, 2))
    rays = np.concatenate([normalise(camera, pixels), np.ones((20, 1))], axis=1)
    again, _, _ = project_points(MODELS.index(model), intrinsics(model), rays)
    np.testing.assert_allclose(again, pixels, atol=1e-4)
    np.testing.assert_allclose(again, project(camera, rays), atol=1e-9)


@pytest.mark.parametrize("model", MODELS)
@given(st.integers(0, 1000))
def test_derivatives_are_those_of_the_projection(model: str, seed: int) -> None:
    number, lens = MODELS.index(model), intrinsics(model)
    points = np.random.default_rng(seed).uniform((-0.5, -0.4, 0.4), (0.5, 0.4, 1.5), (10, 3))
    _, by_point, by_intrinsics = project_points(number, lens, points)
    for axis in range(3):
        step = np.zeros(3)
        step[axis] = 1e-6
        there, back = (project_points(number, lens, points + sign * step)[0] for sign in (1.0, -1.0))
        np.testing.assert_allclose(by_point[:, :, axis], (there - back) / 2e-6, rtol=1e-5, atol=1e-4)
    for parameter in range(8 if model != "none" else 4):
        step = np.zeros(8)
        step[parameter] = 1e-6
        there, back = (project_points(number, lens + sign * step, points)[0] for sign in (1.0, -1.0))
        np.testing.assert_allclose(by_intrinsics[:, :, parameter], (there - back) / 2e-6, rtol=1e-5, atol=1e-4)


def test_the_middle_of_a_fisheye_is_a_pinhole() -> None:
    _, by_point, _ = project_points(2, intrinsics("equidistant"), np.array([[0.0, 0.0, 2.0]]))
    np.testing.assert_allclose(by_point[0], [[230.0, 0.0, 0.0], [0.0, 227.5, 0.0]], atol=1e-9)


def test_points_behind_the_lens_have_no_pixel() -> None:
    pixels, _, _ = project_points(1, intrinsics("radtan"), np.array([[0.1, 0.1, -1.0]]))
    assert np.isnan(pixels).all()
