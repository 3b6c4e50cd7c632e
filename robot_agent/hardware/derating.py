"""Hot servos get less torque, before they shut down by themselves and let go."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BEGINS, ENDS = 65.0, 75.0
"""Degrees Celsius; above, safety lets the robot sit, and at 80 the servo shuts down."""
LEAST = 0.5
"""Share of the torque at the end: standing still takes a quarter of it."""


def derated(torque: Array, temperature: Array) -> Array:
    """Torque limits (joints,) in N m at these temperatures (joints,), degrees Celsius; NaN counts as cool."""
    hot = np.clip((np.nan_to_num(temperature, nan=0.0) - BEGINS) / (ENDS - BEGINS), 0.0, 1.0)
    share: Array = torque * (1.0 - (1.0 - LEAST) * hot)
    return share
