"""The constant gait parameters that adaptation is compared with: those an adaptive walk takes where it is roughest.

The paper tunes its non-adaptive set "to match the locomotion behaviour of the adaptive controller on the roughest
terrain part" (ICRA'17 IV-C): a constant set has to pass the worst place of the course.
"""

from __future__ import annotations

import numpy as np

from robot_agent.adaptation import safe_gait
from sim_agent.testbed_study.walk import WalkRecord
from weaver_shared.config.adaptation import AdaptationConfig

PARAMETERS = ("virtual_stiffness", "stride_frequency", "stride_height")
PLACE = 0.25
"""m along the course whose mean counts: about a stride."""
DIGITS = 3
"""Significant ones: what a person would tune by hand."""


def fixed_set(reference: WalkRecord, adaptation: AdaptationConfig) -> dict[str, float]:
    """Means of the parameters over the place of the `reference` walk with the lowest stride frequency.

    Places the robot knew nothing of do not count. A walk that did not reach the end is no reference: then the gait for
    unknown ground is the fixed set.
    """
    known = np.isfinite(reference.rows["roughness"])
    if reference.outcome != "reached" or not known.any():
        return safe_gait(adaptation)
    place = np.floor(reference.rows["x"] / PLACE).astype(np.int64)
    means = {
        int(number): {name: float(reference.rows[name][known & (place == number)].mean()) for name in PARAMETERS}
        for number in np.unique(place[known])
    }
    slowest = min(means.values(), key=lambda values: values["stride_frequency"])
    return {name: float(f"{slowest[name]:.{DIGITS}g}") for name in PARAMETERS}
