"""Where time comes from: the robot's own clock, real or simulated. No stage reads a clock, loops hand time in."""

import time
from typing import Protocol


class Clock(Protocol):
    def now_ns(self) -> int:
        """Nanoseconds since an origin of the clock's own; never runs backwards."""
        ...

    def sleep_until(self, stamp_ns: int) -> None:
        """Return when `now_ns()` has reached `stamp_ns`; at once if it already has."""
        ...


class MonotonicClock:
    """The computer's monotonic clock, which no wall-clock step can move."""

    def now_ns(self) -> int:
        return time.monotonic_ns()

    def sleep_until(self, stamp_ns: int) -> None:
        remaining = stamp_ns - time.monotonic_ns()
        if remaining > 0:
            time.sleep(remaining * 1e-9)


class SimulatedClock:
    """A clock that only moves when told to: by a simulator's step or by a test."""

    def __init__(self, start_ns: int = 0) -> None:
        self._now_ns = start_ns

    def now_ns(self) -> int:
        return self._now_ns

    def sleep_until(self, stamp_ns: int) -> None:
        self._now_ns = max(self._now_ns, stamp_ns)

    def forward(self, *, seconds: float = 0.0, nanoseconds: int = 0) -> None:
        step = round(seconds * 1e9) + nanoseconds
        if step < 0:
            raise ValueError(f"time can not run backwards by {-step} ns")
        self._now_ns += step
