"""Levelling by the IMU: a PID on the body's tilt whose answer turns the body over its feet (OpenSHC'20 IV-B)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.locomotion import LevellingConfig

Array = NDArray[np.float64]


class Levelling:
    """Roll and pitch, rad. The integral stops where the answer is at its limit and would be pushed further."""

    def __init__(self, config: LevellingConfig, dt: float) -> None:
        self._config = config
        self._dt = dt
        self._blend = dt / (config.rate_time + dt)
        self.clear()

    def clear(self) -> None:
        self._integral = np.zeros(2)
        self._rate = np.zeros(2)
        self._last: Array | None = None
        self.answer = np.zeros(2)

    def step(self, error: Array) -> Array:
        """Turn (2,) rad to be added about x and y, for a tilt `error` (2,) rad still to be undone."""
        config = self._config
        if self._last is not None:
            self._rate += self._blend * ((error - self._last) / self._dt - self._rate)
        self._last = error.copy()
        free = config.proportional * error + self._integral + config.derivative * self._rate
        grown = self._integral + config.integral * error * self._dt
        growing = np.abs(grown) > np.abs(self._integral)
        saturated = np.abs(free) >= config.largest
        self._integral = np.where(saturated & growing, self._integral, grown)
        np.clip(self._integral, -config.largest, config.largest, out=self._integral)
        self.answer = np.clip(free, -config.largest, config.largest)
        return self.answer


def tilt_error(up_in_wanted: Array) -> Array:
    """The turn (2,) rad about x and y that brings z onto `up_in_wanted` (3,), up as the wanted body would feel it."""
    x, y, z = up_in_wanted
    sine = float(np.hypot(x, y))
    if sine < 1e-12:
        return np.zeros(2)
    angle = float(np.arctan2(sine, z))
    return np.array([-y, x]) * (angle / sine)
