"""Whether the buses are fast enough for the control loop, judged from cycles that nobody was missing from."""

from __future__ import annotations

from collections import deque
from statistics import median

BUDGET = 8e-3  # s of a tick of 10 ms
CYCLES = 50


class CyclePace:
    def __init__(self) -> None:
        self._taken: deque[float] = deque(maxlen=CYCLES)
        self.typical = 0.0
        """s of the median cycle; 0 until there are enough."""

    def add(self, seconds: float) -> None:
        self._taken.append(seconds)
        if len(self._taken) == CYCLES:
            self.typical = median(self._taken)

    @property
    def slow(self) -> bool:
        return self.typical > BUDGET
