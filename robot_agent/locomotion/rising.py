"""Standing up and sitting down: smooth from wherever the joints are, at a bounded speed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def smooth(progress: float) -> float:
    """Quintic from 0 to 1 without speed or acceleration at either end."""
    t = min(max(progress, 0.0), 1.0)
    return t * t * t * (10.0 + t * (6.0 * t - 15.0))


class Glide:
    """An array that moves from where it is to a goal; the mean speed of its farthest element is `speed` per s."""

    def __init__(self, start: Array, goal: Array, speed: float) -> None:
        self._start, self._goal = start.copy(), goal.copy()
        self._duration = float(np.abs(goal - start).max()) / speed
        self._time = 0.0

    @property
    def done(self) -> bool:
        return self._time >= self._duration

    @property
    def progress(self) -> float:
        return 1.0 if self.done else smooth(self._time / self._duration)

    def step(self, dt: float) -> Array:
        self._time += dt
        result: Array = self._start + self.progress * (self._goal - self._start)
        return result
