"""The console's list of events: of every robot and of its own, numbered so that each page reads on where it was."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from weaver_shared.messages import Severity

KEPT = 2000
SHOWN_AT_START = 200


@dataclass(frozen=True, slots=True, kw_only=True)
class PastEvent:
    robot: str  # empty: the console itself
    stamp_ns: int  # robot's clock, 0 for the console's own
    time: float  # unix seconds on the console's computer
    severity: Severity
    source: str
    text: str

    def to_page(self) -> dict[str, object]:
        names = ("robot", "stamp_ns", "time", "severity", "source", "text")
        return {name: getattr(self, name) for name in names}


@dataclass(frozen=True, slots=True, kw_only=True)
class LoggedEvent(PastEvent):
    number: int


class EventLog:
    def __init__(self, wall_time: Callable[[], float] = time.time) -> None:
        self._events: deque[LoggedEvent] = deque(maxlen=KEPT)
        self._lock = threading.Lock()
        self._number = 0
        self._wall_time = wall_time

    def add(self, robot: str, severity: Severity, source: str, text: str, *, stamp_ns: int = 0) -> None:
        with self._lock:
            self._number += 1
            event = LoggedEvent(
                number=self._number,
                robot=robot,
                stamp_ns=stamp_ns,
                time=self._wall_time(),
                severity=severity,
                source=source,
                text=text,
            )
            self._events.append(event)

    def restore(self, past: PastEvent) -> int:
        """Enter an event of an earlier run, before any of this one; returns its number."""
        with self._lock:
            self._number += 1
            names = ("robot", "stamp_ns", "time", "severity", "source", "text")
            self._events.append(LoggedEvent(number=self._number, **{name: getattr(past, name) for name in names}))
            return self._number

    def since(self, number: int) -> list[LoggedEvent]:
        """Events after `number`, oldest first; a reader that was away too long misses the oldest."""
        with self._lock:
            if number >= self._number:
                return []
            return [event for event in self._events if event.number > number]

    def latest(self, count: int = SHOWN_AT_START) -> list[LoggedEvent]:
        with self._lock:
            return list(self._events)[-count:]
