"""What has come for subscribers, taken in batches by one thread, the newest of each key where only that counts.

Zenoh calls a subscriber back for every message, and each call waits for its turn at the interpreter. Who hears a whole
fleet falls behind for good when it is short of computing time, and then shows what is long past. Here messages
wait outside the interpreter, and what newer ones have replaced is never read.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

PERIOD = 0.002
"""s between two looks."""

ROOM, LOGGED_ROOM = 1024, 8192
"""Messages that wait for a subscriber; beyond, the oldest go."""

Deliver = Callable[[str, bytes], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Subscriber:
    channel: Any
    deliver: Deliver
    each_counts: bool


class Drain:
    """`declare` from any thread; `deliver` is called with full key and payload, in the drain's own thread."""

    def __init__(self, declare: Callable[[str, int], Any]) -> None:
        """`declare` makes a Zenoh subscriber of a key pattern that keeps so many messages."""
        self._declare = declare
        self._subscribers: tuple[_Subscriber, ...] = ()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bus", daemon=True)
        self._thread.start()

    def declare(self, pattern: str, deliver: Deliver, *, each_counts: bool) -> None:
        channel = self._declare(pattern, LOGGED_ROOM if each_counts else ROOM)
        new = _Subscriber(channel=channel, deliver=deliver, each_counts=each_counts)
        self._subscribers = (*self._subscribers, new)

    def close(self) -> None:
        self._ended.set()
        if self._thread is not threading.current_thread():
            self._thread.join()

    def _run(self) -> None:
        while not self._ended.wait(PERIOD):
            for subscriber in self._subscribers:
                self._take(subscriber)

    def _take(self, subscriber: _Subscriber) -> None:
        newest: dict[object, tuple[str, Any]] = {}
        while (sample := subscriber.channel.try_recv()) is not None:
            key = str(sample.key_expr)
            newest[len(newest) if subscriber.each_counts else key] = (key, sample.payload)
        for key, payload in newest.values():
            subscriber.deliver(key, payload.to_bytes())
