"""Lets torque come gently: from where the joints are, with little torque that grows, and slowly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.hardware import ServoSettings

Array = NDArray[np.float64]


class SoftStart:
    """Begins anew with `begin`; once every joint is where it is wanted and the time is over it changes nothing."""

    def __init__(self, settings: ServoSettings) -> None:
        self._settings = settings
        self._position: Array | None = None
        self._elapsed = 0.0
        self._least_torque = settings.start_torque

    def begin(self, position: Array, *, holding: bool = False) -> None:
        """From these joint angles (joints,) in rad; `holding` servos bear the robot and keep their whole torque."""
        self._position = position.copy()
        self._elapsed = 0.0
        self._least_torque = 1.0 if holding else self._settings.start_torque

    def limit(self, position: Array, torque: Array, dt: float) -> tuple[Array, Array]:
        """What of wanted angles and torque limits (joints,) the servos are told now, dt s after the last time."""
        if self._position is None:
            return position, torque
        self._elapsed += dt
        step = self._settings.start_speed * dt
        self._position = np.clip(position, self._position - step, self._position + step)
        share = min(self._elapsed / self._settings.start_time, 1.0)
        told, allowed = self._position, torque * (self._least_torque + (1.0 - self._least_torque) * share)
        if share == 1.0 and np.array_equal(self._position, position):
            self._position = None
        return told, allowed
