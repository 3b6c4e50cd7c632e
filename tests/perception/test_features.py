"""Roughness and step height mean what eqs. 7 and 8 say: nothing on flat ground, more on rougher, unknown if unseen."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.perception.features import characterise, patch_features, roughness_of, step_height_of
from weaver_shared.config.perception import FeatureConfig

CONFIG = FeatureConfig()
CELL = 0.02


def rough(scale, seed=0, shape=(30, 40)):
    return scale * np.random.default_rng(seed).normal(size=shape)


def test_flat_ground_has_no_features():
    features = patch_features(np.zeros((30, 40)), CELL, 0.0, CONFIG)
    assert features == pytest.approx(np.zeros(7))
    assert roughness_of(features, CONFIG) == step_height_of(features, CONFIG) == 0.0


def test_the_noise_of_the_sensor_is_not_roughness():
    noisy = rough(0.003)
    literal = patch_features(noisy, CELL, 0.0, CONFIG)
    known = patch_features(noisy, CELL, 0.003, CONFIG)
    assert roughness_of(literal, CONFIG) > 0.05
    assert roughness_of(known, CONFIG) < 0.02


def test_features_of_normal_ground_are_those_of_the_normal_law():
    f1, f2, f3, _, _, f6, _ = patch_features(rough(0.02, shape=(300, 400)), CELL, 0.0, CONFIG)
    assert (f1, f2, f3, f6) == pytest.approx((0.01596, 0.02, 0.0658, 0.0411), rel=0.02)


def test_a_step_counts_its_edge_and_its_height():
    residual = np.zeros((30, 40))
    residual[:, 20:] = 0.1
    *_, f4, f5, f6, f7 = patch_features(residual, CELL, 0.0, CONFIG)
    assert f7 == pytest.approx(0.1)
    assert f4 == pytest.approx(30 / (29 * 40 + 30 * 39))
    assert f6 == pytest.approx(0.1)
    assert f5 == pytest.approx((np.sqrt(26.0) - 1.0) / 39, rel=1e-6)


@given(st.floats(0.001, 0.02), st.floats(1.01, 3.0))
def test_higher_relief_is_never_smoother(scale, factor):
    low, high = (patch_features(rough(s), CELL, 0.0, CONFIG) for s in (scale, scale * factor))
    assert (high >= low - 1e-12)[[0, 1, 2, 3, 4, 5]].all()
    assert roughness_of(high, CONFIG) >= roughness_of(low, CONFIG)
    assert 0.0 <= step_height_of(high, CONFIG) <= 1.0


def test_nothing_seen_is_unknown_and_not_flat():
    features = patch_features(np.full((30, 40), np.nan), CELL, 0.0, CONFIG)
    result = characterise(features, 0.0, 0.48, 0.0, CONFIG)
    assert np.isnan(features).all()
    assert np.isnan(result.roughness)
    assert np.isnan(result.step_height)


def test_less_seen_is_less_sure():
    features = patch_features(rough(0.01), CELL, 0.0, CONFIG)
    sigmas = [characterise(features, coverage, 0.48, 0.002, CONFIG).roughness_sigma for coverage in (1.0, 0.6, 0.3)]
    assert sigmas == sorted(sigmas)
    assert sigmas[0] < sigmas[-1]
