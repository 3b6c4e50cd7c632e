"""The inertial samples of the last while, kept without moving them at every arrival."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class RecentSamples:
    """Up to `capacity` newest samples: stamps (n,) in ns and rows (n, 7) of duration (s), rate and specific force."""

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        # Twice the room, so that only every `capacity`-th sample moves the ones before it.
        self._stamps = np.zeros(2 * capacity, dtype=np.int64)
        self._rows = np.zeros((2 * capacity, 7))
        self._end = 0

    def add(self, stamp_ns: int, dt: float, gyro: Array, accel: Array) -> Array:
        """Keep a sample that is newer than all before it; returns its row as (1, 7)."""
        if self._end == len(self._stamps):
            self._stamps[: self._capacity] = self._stamps[self._capacity :]
            self._rows[: self._capacity] = self._rows[self._capacity :]
            self._end = self._capacity
        row = self._rows[self._end : self._end + 1]
        row[0, 0], row[0, 1:4], row[0, 4:7] = dt, gyro, accel
        self._stamps[self._end] = stamp_ns
        self._end += 1
        return row

    def since(self, stamp_ns: int) -> Array:
        """Rows of what was felt after `stamp_ns`; the first is cut where it began before. A copy, (n, 7)."""
        begin = max(0, self._end - self._capacity)
        stamps = self._stamps[begin : self._end]
        first = int(np.searchsorted(stamps, stamp_ns, side="right"))
        rows = self._rows[begin + first : self._end].copy()
        if len(rows):
            rows[0, 0] = min(rows[0, 0], (int(stamps[first]) - stamp_ns) * 1e-9)
        return rows
