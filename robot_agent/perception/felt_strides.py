"""What changes from stride to stride: the load of a leg and the body's tilt, which on even ground repeat themselves.

Averaging over a stride takes out what the gait does to the body; comparing it with the stride before takes out how the
load is shared and how the ground slopes.
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STANDSTILL = 10
"""Readings in a row with all feet on the ground, after which the robot is not walking: loads are shared by all."""
SETTLING = 2
"""Stances of every leg after a standstill that do not count: the robot is still gathering way."""
FEWEST_LOOKS = 2
"""Readings that make a stance or a stride: fewer are chance."""


class _Mean:
    """Of values that come one by one, since it was last taken."""

    def __init__(self) -> None:
        self._sum: Array | float = 0.0
        self._count = 0

    def add(self, value: Array | float) -> None:
        self._sum, self._count = self._sum + value, self._count + 1

    def take(self) -> Array | float | None:
        """The mean, which begins anew; None of too few values."""
        total, count = self._sum, self._count
        self._sum, self._count = 0.0, 0
        return total / count if count >= FEWEST_LOOKS else None


class StrideChanges:
    """Follows loads and tilt through stances and strides; a stride ends when the first leg stands anew."""

    def __init__(self, legs: int, strides: int) -> None:
        self._stance = [_Mean() for _ in range(legs)]
        self._stood = np.zeros(legs, dtype=np.bool_)
        self._all_stood = 0  # readings
        self._to_settle = np.full(legs, SETTLING)
        self._last_load: list[float | None] = [None] * legs
        self._load_changes: deque[float] = deque(maxlen=strides * legs)
        self._stride = _Mean()
        self._last_tilt: Array | float | None = None
        self._tilt_changes: deque[float] = deque(maxlen=strides)

    def step(self, load: Array, tilt: Array) -> None:
        """`load` (legs,) in N of the feet that stand, NaN of the others; `tilt` (2,) rad along and across."""
        stands = np.isfinite(load)
        for leg in np.flatnonzero(stands):
            self._stance[leg].add(float(load[leg]))
        for leg in np.flatnonzero(self._stood & ~stands):
            self._end_stance(int(leg))
        if stands[0] and not self._stood[0]:
            self._end_stride()
        self._stride.add(tilt)
        self._stood = stands
        self._all_stood = self._all_stood + 1 if stands.all() else 0
        if self._all_stood >= STANDSTILL:
            self._begin_anew()

    @property
    def load_change(self) -> float:
        """Median change (N) of a leg's mean load from one stance to the next; NaN before every leg has two stances."""
        return float(np.median(self._load_changes)) if len(self._load_changes) >= len(self._stance) else float("nan")

    @property
    def tilt_change(self) -> float:
        """Mean change (rad) of a stride's mean tilt, per square root of two: a deviation; NaN before two changes."""
        return float(np.mean(self._tilt_changes) / np.sqrt(2.0)) if len(self._tilt_changes) >= 2 else float("nan")

    def _begin_anew(self) -> None:
        """No stance or stride of a walk compares with standing still."""
        for mean in (*self._stance, self._stride):
            mean.take()
        self._last_load = [None] * len(self._stance)
        self._last_tilt = None
        self._to_settle[:] = SETTLING

    def _end_stance(self, leg: int) -> None:
        mean, last = self._stance[leg].take(), self._last_load[leg]
        self._to_settle[leg] = max(self._to_settle[leg] - 1, -1)
        if mean is None or self._to_settle[leg] >= 0:
            return
        self._last_load[leg] = float(mean)
        if last is not None:
            self._load_changes.append(abs(float(mean) - last))

    def _end_stride(self) -> None:
        mean, last = self._stride.take(), self._last_tilt
        if mean is None:
            return
        self._last_tilt = mean
        if last is not None:
            self._tilt_changes.append(float(np.linalg.norm(mean - last)))
