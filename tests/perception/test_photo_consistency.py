"""What is too near to be matched is unknown: never a pit."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from robot_agent.perception.photo_consistency import PhotoConsistency
from robot_agent.perception.stereo_matching import StereoMatcher
from weaver_shared.config.perception import MatchingConfig

CONFIG = MatchingConfig()
FAR, TOO_NEAR = 30, 84  # px of disparity; 64 are searched
BLOCK = np.s_[130:230, 170:300]
"""Rows and columns of the left picture in which the near surface is seen."""

Picture = NDArray[np.uint8]


def _texture(random: np.random.Generator, width: int = 500) -> NDArray[np.float64]:
    grain = random.normal(size=(240, width))
    return np.asarray(110.0 + 120.0 * cv2.GaussianBlur(grain, (0, 0), 1.2), dtype=np.float64)


def _pair(seed: int, near: int, noise: float = 1.5, gain: float = 1.0) -> tuple[Picture, Picture]:
    """A wall, and before it a block at disparity `near`; the right eye is `gain` as bright and 6 darker."""
    random = np.random.default_rng(seed)
    wall, block = _texture(random), _texture(random)
    left, right = wall[:, :320].copy(), wall[:, FAR : FAR + 320].copy()
    left[BLOCK] = block[BLOCK]
    rows, columns = BLOCK
    right[rows, columns.start - near : columns.stop - near] = block[BLOCK]
    eyes = (left, gain * right - 6.0)
    noisy = (np.clip(eye + noise * random.normal(size=eye.shape), 0, 255) for eye in eyes)
    first, second = (eye.astype(np.uint8) for eye in noisy)
    return first, second


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_what_is_nearer_than_is_searched_gets_no_distance(seed: int):
    disparity = StereoMatcher(CONFIG).match(*_pair(seed, TOO_NEAR))
    inside = disparity[BLOCK][8:-8, 8:-8]
    assert np.mean(inside > 0) < 0.02


@pytest.mark.parametrize(("noise", "gain"), [(1.5, 1.0), (4.0, 1.0), (1.5, 0.85)])
def test_what_is_searched_keeps_its_distance(noise: float, gain: float):
    disparity = StereoMatcher(CONFIG).match(*_pair(4, 50, noise, gain))
    inside = disparity[BLOCK][8:-8, 8:-8]
    assert np.mean(np.abs(inside / 16.0 - 50.0) < 0.5) > 0.97
    beside = disparity[8:120, 80:300]
    assert np.mean(np.abs(beside / 16.0 - FAR) < 0.5) > 0.97


def test_noise_on_a_blank_wall_is_no_difference():
    random = np.random.default_rng(5)
    left, right = (np.clip(120.0 + 3.0 * random.normal(size=(240, 320)), 0, 255).astype(np.uint8) for _ in range(2))
    unlike = PhotoConsistency(CONFIG.largest_difference, CONFIG.picture_noise).unlike(
        left, right, np.full((240, 320), FAR * 16, dtype=np.int16)
    )
    assert np.mean(unlike) < 0.01
