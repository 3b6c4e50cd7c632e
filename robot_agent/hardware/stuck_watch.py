"""Joints that do not go where they are told although their motors pull as hard as they may: something is in the way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ERROR = 0.26
"""rad, 15 degrees behind: three times what walking over the testbed takes."""
FREED = 0.13  # rad
AT_CAP = 0.8
"""Share of the torque it is allowed."""
PERIOD = 0.3  # s
EASED = 0.3
"""Share of its torque that a stuck joint keeps, so that motor and gears survive what holds it."""


class StuckWatch:
    def __init__(self, joints: int) -> None:
        self.stuck = np.zeros(joints, dtype=np.bool_)
        self._seconds = np.zeros(joints)

    def step(self, goal: Array, position: Array, torque: Array, cap: Array, dt: float) -> None:
        """Angles (joints,) in rad as told and as they are, torques and their caps (joints,) in N m, dt s."""
        behind = np.abs(goal - position)
        pulling = (behind > ERROR) & (np.abs(torque) >= AT_CAP * cap)
        self._seconds = np.where(pulling, self._seconds + dt, 0.0)
        self.stuck = (self.stuck | (self._seconds >= PERIOD)) & (behind > FREED)

    def clear(self) -> None:
        self.stuck[:] = False
        self._seconds[:] = 0.0

    def ease(self, torque: Array) -> Array:
        """Torque limits (joints,) with those of stuck joints reduced."""
        eased: Array = np.where(self.stuck, EASED * torque, torque)
        return eased
