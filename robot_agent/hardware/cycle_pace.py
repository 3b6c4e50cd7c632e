"""Whether the buses are fast enough for the control loop: what a whole cycle takes, and answers that come late."""

from __future__ import annotations

from collections import deque
from statistics import median

BUDGET = 8e-3  # s of a tick of 10 ms
CYCLES = 50
LATE = 3
"""Cycles of these with answers after their time: not the computer's fault any more."""


class CyclePace:
    def __init__(self) -> None:
        self._taken: deque[float] = deque(maxlen=CYCLES)
        self._late: deque[bool] = deque(maxlen=CYCLES)
        self.typical = 0.0
        """s of the median cycle; 0 until there are enough."""

    def add(self, seconds: float, *, complete: bool, late: bool) -> None:
        """A cycle: what it took, whether all answered, and whether answers to the one before came after it."""
        self._late.append(late)
        if complete:
            self._taken.append(seconds)
        if len(self._taken) == CYCLES:
            self.typical = median(self._taken)

    @property
    def slow(self) -> bool:
        return self.typical > BUDGET or sum(self._late) >= LATE
