"""Features f1..f7 of a patch about its plane, roughness and step height (ICRA'17 III-D, eqs. 7 and 8).

Of the features the paper prints only the first, the centre line average; the others are our choice:
f1 centre line average (mean absolute residual, m), f2 root mean square residual (m), f3 spread of the residuals from
the 5th to the 95th percentile (m), f4 edge density (share of neighbouring cells whose residuals differ by more than
the edge height), f5 surface area over its projection, less one, f6 height of the 98th percentile above the plane (m),
f7 mean height of the edges (m).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.perception import FeatureConfig

Array = NDArray[np.float64]

HALF_NORMAL_MEAN = float(np.sqrt(2.0 / np.pi))
"""Centre line average of a normal law over its root mean square."""
SPREAD_5_95 = 3.2897
"""Distance of a normal law's 5th and 95th percentile over its standard deviation."""
PERCENTILE_98 = 2.0537
"""98th percentile of a standard normal law."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Roughness:
    """Roughness and step height, 0..1, with standard deviations; NaN where unknown."""

    roughness: float
    roughness_sigma: float
    step_height: float
    step_height_sigma: float

    @staticmethod
    def unknown() -> Roughness:
        return Roughness(roughness=np.nan, roughness_sigma=np.nan, step_height=np.nan, step_height_sigma=np.nan)


def patch_features(residual: Array, cell: float, noise: float, config: FeatureConfig) -> Array:
    """f1..f7 of residuals about the plane (rows, columns) in m, NaN unknown, in cells of `cell` m.

    `noise` is the standard deviation of one cell's height (m); what it alone would give is taken off. With `noise` 0
    the features are the literal ones. NaN if fewer than three cells are known.
    """
    known = residual[np.isfinite(residual)]
    if len(known) < 3:
        return np.full(7, np.nan)
    low, high, peak = np.percentile(known, [5.0, 95.0, 98.0])
    steps = np.concatenate([np.diff(residual, axis=axis).ravel() for axis in (0, 1)])
    steps = np.abs(steps[np.isfinite(steps)])
    edges = steps[steps > config.edge_height + 2.0 * noise]
    return np.array(
        [
            _less_noise(float(np.abs(known).mean()), HALF_NORMAL_MEAN * noise),
            _less_noise(float(np.sqrt((known**2).mean())), noise),
            _less_noise(float(high - low), SPREAD_5_95 * noise),
            len(edges) / max(1, len(steps)),
            _area_ratio(residual, cell, noise),
            _less_noise(max(0.0, float(peak)), PERCENTILE_98 * noise),
            float(edges.mean()) if len(edges) else 0.0,
        ]
    )


def roughness_of(features: Array, config: FeatureConfig) -> float:
    """Eq. 7, clamped to 0..1; NaN for unknown features."""
    value = float(np.dot(config.roughness_weights, features[:5])) / config.roughness_norm
    return float(np.clip(value, 0.0, 1.0))


def step_height_of(features: Array, config: FeatureConfig) -> float:
    """Eq. 8, clamped to 0..1; NaN for unknown features."""
    value = (config.peak_weight * features[5] + config.edge_weight * features[3] * features[6]) / config.step_norm
    return float(np.clip(value, 0.0, 1.0))


def characterise(features: Array, coverage: float, area: float, noise: float, config: FeatureConfig) -> Roughness:
    """Roughness and step height of a patch of `area` m^2 of which `coverage` (0..1) was seen, with their sigmas."""
    roughness, step_height = roughness_of(features, config), step_height_of(features, config)
    relative = relative_sigma(coverage, area)
    roughness_noise = sum(config.roughness_weights[:3]) * noise / config.roughness_norm * NOISE_LEFT
    step_noise = config.peak_weight * noise / config.step_norm
    return Roughness(
        roughness=roughness,
        roughness_sigma=min(1.0, float(np.hypot(relative * roughness, roughness_noise))),
        step_height=step_height,
        step_height_sigma=min(1.0, float(np.hypot(relative * step_height, step_noise))),
    )


NOISE_LEFT = 0.5
"""Share of a cell's noise that remains in a feature after the expected noise was taken off."""

UNSEEN_ERROR = 0.4
"""Relative error of a feature by cells not seen; blocks 40 % hidden read 15-25 % low."""

CORRELATION_LENGTH = 0.1
"""m over which rough ground stays alike: a patch holds area / length^2 independent samples."""


def relative_sigma(coverage: float, area: float) -> float:
    """Relative standard deviation of a patch's features from what it did not see and how little of it there is."""
    samples = max(1.0, coverage * area / CORRELATION_LENGTH**2)
    return float(np.hypot(UNSEEN_ERROR * (1.0 - coverage), 1.0 / np.sqrt(2.0 * samples)))


def _less_noise(value: float, noise: float) -> float:
    return float(np.sqrt(max(0.0, value**2 - noise**2)))


def _area_ratio(residual: Array, cell: float, noise: float) -> float:
    """Mean of sqrt(1 + slope^2) over cells with both neighbours, less one; the noise's slope is taken off."""
    down = np.diff(residual, axis=0)[:, :-1] / cell
    right = np.diff(residual, axis=1)[:-1, :] / cell
    squared = down**2 + right**2
    squared = squared[np.isfinite(squared)]
    if not len(squared):
        return 0.0
    return float(np.sqrt(1.0 + np.maximum(0.0, squared - 4.0 * (noise / cell) ** 2)).mean() - 1.0)
