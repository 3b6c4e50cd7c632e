"""Measures a running loop: its rate, the spread of its period, its share of a core and how fast simulated time goes."""

from __future__ import annotations

import time

import numpy as np

from weaver_shared.messages import LoopTiming


class LoopMeter:
    """Call `woke` at each turn. Only reports; nothing of it flows back into the loop."""

    def __init__(self, name: str, nominal_rate: float) -> None:
        self._name = name
        self._period = 1.0 / nominal_rate
        self._wakes: list[float] = []
        self._counted = 0  # of the wakes kept, those that an earlier report has counted
        self._first_stamp_ns: int | None = None
        self._cpu = time.process_time()
        self._wall = time.monotonic()

    def woke(self, stamp_ns: int) -> None:
        if self._first_stamp_ns is None:
            self._first_stamp_ns = stamp_ns
            self._wall = time.monotonic()
            self._counted = 1  # time is measured from this wake on
        self._wakes.append(time.monotonic())

    def report(self, stamp_ns: int) -> LoopTiming:
        """Timing since the previous report."""
        wall, cpu = time.monotonic(), time.process_time()
        elapsed = max(wall - self._wall, 1e-9)
        errors = np.abs(np.diff(self._wakes) - self._period) if len(self._wakes) > 1 else np.zeros(1)
        begun_ns = stamp_ns if self._first_stamp_ns is None else self._first_stamp_ns
        timing = LoopTiming(
            name=self._name,
            stamp_ns=stamp_ns,
            rate=(len(self._wakes) - self._counted) / elapsed,
            period_error_p99=float(np.percentile(errors, 99)),
            overruns=int(np.count_nonzero(errors > self._period)),
            cpu_fraction=(cpu - self._cpu) / elapsed,
            real_time_factor=(stamp_ns - begun_ns) * 1e-9 / elapsed,
        )
        self._wakes = self._wakes[-1:]  # the next period begins at it
        self._counted = len(self._wakes)
        self._first_stamp_ns = stamp_ns
        self._cpu, self._wall = cpu, wall
        return timing
