"""Running sums give every cell what a least-squares plane through its square would give."""

import numpy as np
import pytest

from robot_agent.mapping.sliding_features import HALF_NORMAL_MEAN, PERCENTILE_98, SPREAD_5_95, cell_features, own_noise
from weaver_shared.config.mapping import MappingConfig
from weaver_shared.config.perception import FeatureConfig

SMOOTH = FeatureConfig(roughness_weights=(8.0, 4.0, 1.2, 0.0, 0.0), roughness_norm=5.0, edge_weight=0.0, step_norm=5.0)
CONFIG = MappingConfig(features=SMOOTH)
HALF = CONFIG.window // 2


def relief(shape=(60, 50), holes=0.0, seed=0):
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(shape[0]) * 0.02, np.arange(shape[1]) * 0.02, indexing="ij")
    z = 0.3 * x - 0.2 * y + 0.03 * np.sin(9.0 * x) * np.cos(7.0 * y) + 0.01 * rng.normal(size=shape)
    return np.where(rng.random(shape) < holes, np.nan, z).astype(np.float32)


def features_of(z, config=CONFIG, variance=0.0):
    return cell_features(z, np.full_like(z, variance), config)


def by_least_squares(z, r, c):
    square = z[max(0, r - HALF) : r + HALF + 1, max(0, c - HALF) : c + HALF + 1].astype(np.float64)
    rows, columns = np.nonzero(np.isfinite(square))
    design = np.column_stack([rows * 0.02, columns * 0.02, np.ones(len(rows))])
    solution, *_ = np.linalg.lstsq(design, square[rows, columns], rcond=None)
    residual = (square[rows, columns] - design @ solution) / np.sqrt(1.0 + solution[0] ** 2 + solution[1] ** 2)
    return np.sqrt((residual**2).mean()), np.hypot(*solution[:2])


@pytest.mark.parametrize("holes", [0.0, 0.4])
def test_deviation_and_slope_equal_least_squares_in_every_square(holes):
    z = relief(holes=holes)
    features = features_of(z)
    per_deviation = (8.0 * HALF_NORMAL_MEAN + 4.0 + 1.2 * SPREAD_5_95) / 5.0
    for r, c in [(30, 25), (5, 40), (56, 30), (20, 2)]:
        deviation, slope = by_least_squares(z, r, c)
        assert features.roughness[r, c] == pytest.approx(per_deviation * deviation, rel=1e-4)
        assert features.step_height[r, c] == pytest.approx(PERCENTILE_98 * deviation / 5.0, rel=1e-4)
        assert features.slope[r, c] == pytest.approx(slope, rel=1e-4)


def test_a_slope_is_not_rough():
    x = np.arange(60)[:, None] * 0.02 + np.zeros((60, 50))
    features = cell_features((0.2 * x).astype(np.float32), np.zeros((60, 50), dtype=np.float32), MappingConfig())
    assert np.nanmax(features.roughness) < 1e-3
    assert np.nanmax(features.step_height) < 1e-3


def test_a_step_is_seen_as_far_as_the_square_reaches_and_no_farther():
    z = np.zeros((60, 50), dtype=np.float32)
    z[30:] = 0.1
    features = features_of(z, MappingConfig())
    assert np.nanmin(features.step_height[30 - HALF + 1 : 30 + HALF - 1]) > 0.2
    assert np.nanmax(features.step_height[: 30 - HALF - 1]) < 1e-6


def test_too_little_known_is_unknown():
    z = np.full((60, 50), np.nan, dtype=np.float32)
    z[25:28, 20:23] = 0.0
    assert np.isnan(features_of(z).roughness).all()


def test_the_noise_of_the_cells_is_taken_off_and_widens_the_sigma():
    z = (0.004 * np.random.default_rng(1).normal(size=(60, 50))).astype(np.float32)
    sure, unsure = features_of(z), features_of(z, variance=0.004**2 + CONFIG.sigma_floor**2)
    assert np.nanmedian(unsure.roughness) < 0.3 * np.nanmedian(sure.roughness)
    assert np.nanmedian(unsure.roughness_sigma) > np.nanmedian(sure.roughness_sigma)


def test_what_all_cells_share_roughens_nothing_and_hides_nothing():
    z = (0.003 * np.random.default_rng(1).normal(size=(60, 50))).astype(np.float32)
    exact, settled = features_of(z), features_of(z, variance=CONFIG.sigma_floor**2)
    assert np.nanmedian(settled.roughness) > 0.95 * np.nanmedian(exact.roughness)
    assert (own_noise(np.zeros((2, 2), dtype=np.float32), CONFIG) == 0.0).all()
