"""Gait parameters as polynomials of roughness and step height (ICRA'17 eqs. 9-11)."""

from __future__ import annotations

import numpy as np

from weaver_shared.config.adaptation import AdaptationConfig

PARAMETERS = ("virtual_stiffness", "stride_frequency", "stride_height")


def gait_for(roughness: float, step_height: float, config: AdaptationConfig) -> dict[str, float]:
    """Virtual stiffness (N/m), stride frequency (Hz) and stride height (m) for r and h, clamped to 0..1 and bounds.

    NaN in either is unknown ground and answered with its rough end.
    """
    r = _known_or_worst(roughness)
    h = _known_or_worst(step_height)
    b0, b1, b2, b3 = config.stiffness_polynomial
    c0, c1, c2 = config.frequency_polynomial
    d0, d1, d2 = config.height_polynomial
    values = {
        "virtual_stiffness": b0 + b1 * r + b2 * r**2 + b3 * r**3,
        "stride_frequency": c0 + c1 * r + c2 * r**2,
        "stride_height": d0 + d1 * h + d2 * r,
    }
    return {name: clamped(name, value, config) for name, value in values.items()}


def safe_gait(config: AdaptationConfig) -> dict[str, float]:
    """The set for ground nothing is known about: soft, slow and high."""
    return gait_for(1.0, 1.0, config)


def clamped(name: str, value: float, config: AdaptationConfig) -> float:
    bounds = getattr(config, name)
    return float(min(max(value, bounds.lower), bounds.upper))


def _known_or_worst(value: float) -> float:
    return 1.0 if np.isnan(value) else float(np.clip(value, 0.0, 1.0))
