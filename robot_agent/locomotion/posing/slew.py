"""A pose that follows any order with bounded rate, acceleration and jerk, and never overshoots it.

A rate limit gives a speed of at most v. The mean over the last T1 seconds of that bounds the acceleration by 2 v / T1,
and the mean over T2 of the result the jerk by 4 v / (T1 T2); means stay between the values they are taken of.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


class Slew:
    """Six values: three lengths (m) and three angles (rad), moving in a straight line towards what is wanted."""

    def __init__(self, rates: tuple[float, float], times: tuple[float, float], dt: float) -> None:
        self._steps = np.array(rates) * dt
        self._limited = np.zeros(6)
        self._first = np.zeros((max(round(times[0] / dt), 1), 6))
        self._second = np.zeros((max(round(times[1] / dt), 1), 6))
        self._ticks = 0
        self._still = 0  # ticks since anything moved
        self.value = np.zeros(6)

    @property
    def at_rest(self) -> bool:
        """Whether nothing of an earlier order is still under way."""
        return self._still > self._first.shape[0] + self._second.shape[0]

    def clear(self) -> None:
        """Be at zero at once: for a robot that does not carry itself."""
        for array in (self._limited, self._first, self._second, self.value):
            array[:] = 0.0
        self._still = self._first.shape[0] + self._second.shape[0] + 1

    def step(self, wanted: Array) -> Array:
        """One tick towards `wanted` (6,)."""
        if self.at_rest and (wanted == self._limited).all():
            return self.value
        moved = follow(wanted, self._steps, self._limited, self._first, self._second, self._ticks, self.value)
        self._still = 0 if moved else self._still + 1
        self._ticks += 1
        return self.value


@kernel
def follow(wanted: Array, steps: Array, limited: Array, first: Array, second: Array, tick: int, value: Array) -> bool:
    """One tick of six values (6,): the rate limit, then both means, whose last inputs are rows of `first`, `second`."""
    far = 0.0
    for part in range(2):
        gap = 0.0
        for k in range(3 * part, 3 * part + 3):
            gap += (wanted[k] - limited[k]) ** 2
        far = max(far, np.sqrt(gap) / steps[part])
    share = 1.0 if far <= 1.0 else 1.0 / far
    for k in range(6):
        limited[k] = wanted[k] if share == 1.0 else limited[k] + share * (wanted[k] - limited[k])
        first[tick % first.shape[0], k] = limited[k]
        total = 0.0
        for i in range(first.shape[0]):
            total += first[i, k] - limited[k]  # sums of nothing once at rest, so that it rests exactly there
        second[tick % second.shape[0], k] = limited[k] + total / first.shape[0]
        middle = second[tick % second.shape[0], k]
        total = 0.0
        for i in range(second.shape[0]):
            total += second[i, k] - middle
        value[k] = middle + total / second.shape[0]
    return far > 0.0
