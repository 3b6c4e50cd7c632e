"""Runs a simulated robot at the pace of the wall clock; when the machine can not keep up, simulated time slows down."""

from __future__ import annotations

from collections.abc import Callable

from weaver_shared.clock import Clock


class Pacer:
    """Waits for the next tick's time. Up to `slack` s of lateness is caught up, more is given up for good."""

    def __init__(self, clock: Clock, *, period: float, slack: float = 0.1) -> None:
        self._clock = clock
        self._period_ns = round(period * 1e9)
        self._slack_ns = round(slack * 1e9)
        self._due_ns = clock.now_ns()

    def wait(self) -> None:
        self._due_ns += self._period_ns
        late = self._clock.now_ns() - self._due_ns
        if late < 0:
            self._clock.sleep_until(self._due_ns)
        elif late > self._slack_ns:
            self._due_ns += late - self._slack_ns


def run_paced(tick: Callable[[], object], pacer: Pacer, ended: Callable[[], bool]) -> None:
    while not ended():
        tick()
        pacer.wait()
