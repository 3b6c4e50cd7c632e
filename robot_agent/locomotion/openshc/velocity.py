"""From the command to the body's velocity: limits by direction, and at most the largest acceleration (facts 3.6)."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.limits import SpeedLimits, limit_towards

Array = NDArray[np.float64]


class BodyVelocity:
    """`linear` (2,) m/s and `angular` rad/s as walked."""

    def __init__(self, mode: Literal["throttle", "real"], dt: float) -> None:
        self._throttle, self._dt = mode == "throttle", dt
        self.linear, self.angular = np.zeros(2), 0.0

    def wanted(self, limits: SpeedLimits, tips: Array, linear: Array, angular: float) -> tuple[Array, float]:
        """What a command asks for: fractions of the largest velocity, or m/s and rad/s, by the mode."""
        speed = limit_towards(limits.linear, tips, linear, angular)
        turn = limit_towards(limits.angular, tips, linear, angular)
        if self._throttle:
            wanted = _shortened(linear, 1.0) * speed
            return wanted * (1.0 - abs(angular)), min(max(angular, -1.0), 1.0) * turn
        slower = min(max(angular, -turn), turn)
        share = 1.0 - abs(slower / turn) if turn != 0.0 else 0.0
        return _shortened(linear, speed) * share, slower

    def approach(
        self, limits: SpeedLimits, tips: Array, linear: Array, angular: float, wanted: tuple[Array, float]
    ) -> None:
        """One tick towards `wanted`; the acceleration allowed is that in the command's direction."""
        change, turn_change = wanted[0] - self.linear, wanted[1] - self.angular
        largest = limit_towards(limits.linear_acceleration, tips, linear, angular) * self._dt
        norm = float(np.linalg.norm(change))
        self.linear = self.linear + (change if norm < largest else change / (norm or 1.0) * largest)
        largest = limit_towards(limits.angular_acceleration, tips, linear, angular) * self._dt
        self.angular += turn_change if abs(turn_change) < largest else (1.0 if turn_change > 0.0 else -1.0) * largest


def _shortened(vector: Array, length: float) -> Array:
    size = float(np.linalg.norm(vector))
    return vector * (length / size) if size > length else vector
