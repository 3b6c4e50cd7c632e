"""Feet tell flat from rough ground on any slope, standing or walking, and say nothing from a few or long ago."""

import numpy as np
import pytest

from robot_agent.perception import BodySense, FeltGround
from weaver_shared.config.perception import FeatureConfig, FeltConfig

SECOND = 1_000_000_000
CONFIG, FEATURES = FeltConfig(), FeatureConfig()


def footholds(n, deviation, seed=0, slope=(0.0, 0.0), middle=(0.0, 0.0)):
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(-0.45, 0.45, (2, n))
    z = slope[0] * x + slope[1] * y + np.hypot(deviation, CONFIG.noise) * rng.normal(size=n)
    return np.column_stack([x + middle[0], y + middle[1], z])


IN_THE_AIR = np.full((6, 3), np.nan)


def sense(standing, place=(0.0, 0.0), stamp_ns=0):
    """Feet that stand with the same load, under a level body."""
    load = np.where(np.isfinite(standing).all(axis=1), 17.0, np.nan)
    return BodySense(stamp_ns=stamp_ns, standing=standing, load=load, tilt=np.zeros(2), place=np.array(place))


def walk(ground, points, place=(0.0, 0.0), stamp_ns=0):
    """Stand on `points` by sixes, every time with the next feet, the last ones staying down."""
    for k in range(0, len(points), 6):
        standing = IN_THE_AIR.copy()
        standing[: len(points[k : k + 6])] = points[k : k + 6]
        ground.step(sense(IN_THE_AIR, place, stamp_ns))
        result = ground.step(sense(standing, place, stamp_ns))
    return result


def felt(points, place=(0.0, 0.0), stamp_ns=0):
    return walk(FeltGround(CONFIG, FEATURES), points, place, stamp_ns)


def roughness_of_normal_ground(deviation):
    """Eq. 7 for residuals of a normal law, edges and area left out."""
    a = FEATURES.roughness_weights
    return min(1.0, (a[0] * 0.798 + a[1] + a[2] * 3.29) * deviation / FEATURES.roughness_norm)


@pytest.mark.parametrize("slope", [(0.0, 0.0), (0.3, -0.2)])
def test_level_and_sloping_ground_feel_flat(slope):
    grounds = [felt(footholds(15, 0.0, seed, slope)) for seed in range(20)]
    assert np.median([ground.roughness for ground in grounds]) < 0.05
    assert np.median([ground.step_height for ground in grounds]) < 0.05
    assert all(ground.roughness < 2.0 * ground.roughness_sigma < 0.3 for ground in grounds)


@pytest.mark.parametrize("deviation", [0.01, 0.02])
def test_rough_ground_feels_as_rough_as_it_looks(deviation):
    found = [felt(footholds(18, deviation, seed)) for seed in range(60)]
    expected = roughness_of_normal_ground(deviation)
    error = np.array([ground.roughness for ground in found]) - expected
    assert abs(error.mean()) < 0.1 * expected
    # The stated doubt covers what it should: two thirds within one, nearly all within two.
    sigma = np.array([ground.roughness_sigma for ground in found])
    assert (np.abs(error) < sigma).mean() > 0.6
    assert (np.abs(error) < 2.0 * sigma).mean() > 0.9


def test_too_few_footholds_or_all_in_a_line_say_nothing():
    assert np.isnan(felt(footholds(CONFIG.fewest - 1, 0.01)).roughness)
    line = np.column_stack([np.linspace(-0.4, 0.4, 12), np.zeros(12), np.zeros(12)])
    assert np.isnan(felt(line).roughness)
    assert np.isnan(felt(np.full((12, 3), np.nan)).roughness)


def test_footholds_far_off_and_long_ago_are_forgotten():
    ground = FeltGround(CONFIG, FEATURES)
    assert walk(ground, footholds(12, 0.03)).roughness > 0.5
    away = np.array([1.5, 0.0])
    assert np.isnan(walk(ground, footholds(3, 0.0, middle=away), away, SECOND).roughness)
    assert walk(ground, footholds(9, 0.0, seed=2, middle=away), away, 2 * SECOND).roughness < 0.05
    ground.step(sense(IN_THE_AIR, away, 3 * SECOND))
    later = int((CONFIG.memory + 4.0) * SECOND)
    assert np.isnan(ground.step(sense(IN_THE_AIR, away, later)).roughness)


def test_feet_that_go_on_standing_are_not_forgotten():
    ground, standing = FeltGround(CONFIG, FEATURES), footholds(6, 0.0)
    for second in range(int(3 * CONFIG.memory)):
        level = ground.step(sense(standing, stamp_ns=second * SECOND))
    assert level.roughness < 0.05 < 2.0 * level.roughness_sigma + 0.05
    assert len(ground._points) == 0


def test_a_foot_that_stands_counts_once_however_long():
    ground, standing = FeltGround(CONFIG, FEATURES), footholds(6, 0.02)
    once = ground.step(sense(standing))
    assert ground.step(sense(standing, stamp_ns=SECOND)) == once
