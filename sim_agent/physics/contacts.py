"""Foot contact as a robot senses it: a threshold with hysteresis, held until it has lasted."""

import numpy as np
from numpy.typing import NDArray

TOUCH_FORCE = 0.05  # of the robot's weight; a leg of six carries 0.17 to 0.33
RELEASE_FORCE = 0.02  # of the weight
SETTLING_TICKS = 2


class ContactSensor:
    """One switch per foot, made for a robot of `weight` N."""

    def __init__(self, legs: int, weight: float) -> None:
        self._touch, self._release = TOUCH_FORCE * weight, RELEASE_FORCE * weight
        self._contact = np.zeros(legs, dtype=np.bool_)
        self._pending = np.zeros(legs, dtype=np.int64)

    def step(self, force: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Contact (legs,) after one control tick with these normal forces (legs,) in N."""
        differs = np.where(self._contact, force < self._release, force > self._touch)
        self._pending = np.where(differs, self._pending + 1, 0)
        changed = self._pending >= SETTLING_TICKS
        self._contact = self._contact ^ changed
        self._pending[changed] = 0
        return self._contact.copy()
