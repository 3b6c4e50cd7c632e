"""Keeps a loop's period and counts what it costs to miss it."""

from dataclasses import dataclass

import numpy as np

from weaver_shared.clock import Clock


@dataclass(frozen=True, slots=True, kw_only=True)
class RateReport:
    """Loop timing since the previous report; errors are |actual - nominal period| in seconds."""

    rate: float
    period_error_median: float
    period_error_p99: float
    overruns: int


class RateKeeper:
    """Wakes at multiples of the period; a late wake-up is counted and the schedule caught up, never bunched."""

    def __init__(self, *, clock: Clock, rate: float, history: int = 4096) -> None:
        if not rate > 0.0:
            raise ValueError(f"a loop rate must be above 0 Hz, got {rate}")
        self._clock = clock
        self._period_ns = round(1e9 / rate)
        self._next_ns = clock.now_ns() + self._period_ns
        self._last_ns = clock.now_ns()
        self._periods_ns = np.zeros(history, dtype=np.int64)
        self._count = 0
        self._overruns = 0

    @property
    def period(self) -> float:
        return self._period_ns * 1e-9

    def wait(self) -> int:
        """Sleep until the next deadline and return the time it woke at, in ns."""
        if self._clock.now_ns() > self._next_ns:
            self._overruns += 1
        self._clock.sleep_until(self._next_ns)
        now = self._clock.now_ns()
        behind = (now - self._next_ns) // self._period_ns
        self._next_ns += (behind + 1) * self._period_ns
        self._periods_ns[self._count % self._periods_ns.size] = now - self._last_ns
        self._last_ns = now
        self._count += 1
        return now

    def report(self) -> RateReport:
        """Timing since the last report; resets the counters."""
        count = min(self._count, self._periods_ns.size)
        periods = self._periods_ns[:count]
        errors = np.abs(periods - self._period_ns) * 1e-9 if count else np.zeros(1)
        result = RateReport(
            rate=float(1e9 / periods.mean()) if count and periods.mean() > 0 else 0.0,
            period_error_median=float(np.median(errors)),
            period_error_p99=float(np.percentile(errors, 99)),
            overruns=self._overruns,
        )
        self._count = 0
        self._overruns = 0
        return result
