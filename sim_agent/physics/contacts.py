"""Foot contact as a robot senses it: a threshold with hysteresis, held until it has lasted."""

import numpy as np
from numpy.typing import NDArray

TOUCH_FORCE = 5.0  # N, a leg carries 17 to 34 N
RELEASE_FORCE = 2.0  # N
SETTLING_TICKS = 2


class ContactSensor:
    """One switch per foot."""

    def __init__(self, legs: int) -> None:
        self._contact = np.zeros(legs, dtype=np.bool_)
        self._pending = np.zeros(legs, dtype=np.int64)

    def step(self, force: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Contact (legs,) after one control tick with these normal forces (legs,) in N."""
        differs = np.where(self._contact, force < RELEASE_FORCE, force > TOUCH_FORCE)
        self._pending = np.where(differs, self._pending + 1, 0)
        changed = self._pending >= SETTLING_TICKS
        self._contact = self._contact ^ changed
        self._pending[changed] = 0
        return self._contact.copy()
