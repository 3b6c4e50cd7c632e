"""What has come for subscribers, taken in batches, the newest of each key where only that counts.

Zenoh calls a subscriber back for every message, and each call waits for its turn at the interpreter. Who hears a whole
fleet falls behind for good when it is short of computing time, and then shows what is long past. Here messages
wait outside the interpreter, and what newer ones have replaced is never read.
"""

from __future__ import annotations

import contextlib
import enum
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

PERIOD = 0.002
"""s between two looks at what should be heard soon, and the least between two takings of what is waited for."""

PATIENCE = 5
"""Looks after which the rest is taken too: tiles, pictures and slow values wait up to 10 ms. Looking at everything
every time cost a tenth of what a console computes."""

ROOM, LOGGED_ROOM = 1024, 8192
"""Messages that wait for a subscriber; beyond, the oldest go."""

Deliver = Callable[[str, bytes], None]


class Haste(enum.Enum):
    """How soon a subscriber hears: at once by a thread that waits for it alone, within 2 ms, or within 10 ms."""

    AWAITED = enum.auto()
    SOON = enum.auto()
    PATIENT = enum.auto()


@dataclass(frozen=True, slots=True, kw_only=True)
class _Subscriber:
    channel: Any
    deliver: Deliver
    each_counts: bool
    haste: Haste


class Drain:
    """`declare` from any thread; `deliver` is called with full key and payload, in one of the drain's threads."""

    def __init__(self, declare: Callable[[str, int], Any], closed: type[Exception]) -> None:
        """`declare` makes a Zenoh subscriber of a key pattern that keeps so many messages; once the session has ended,
        waiting at it raises `closed`."""
        self._declare = declare
        self._closed = closed
        self._subscribers: tuple[_Subscriber, ...] = ()
        self._ended = threading.Event()
        self._threads = [threading.Thread(target=self._look, name="bus", daemon=True)]
        self._threads[0].start()

    def declare(self, pattern: str, deliver: Deliver, *, each_counts: bool, haste: Haste = Haste.SOON) -> None:
        channel = self._declare(pattern, LOGGED_ROOM if each_counts else ROOM)
        new = _Subscriber(channel=channel, deliver=deliver, each_counts=each_counts, haste=haste)
        if haste is Haste.AWAITED:
            waiting = threading.Thread(target=self._await, args=(new,), name=f"bus {pattern}", daemon=True)
            self._threads.append(waiting)
            waiting.start()
        else:
            self._subscribers = (*self._subscribers, new)

    def end(self) -> None:
        """Look no more; call it before the session that feeds the subscribers is closed."""
        self._ended.set()
        self._join(self._threads[0])

    def wait(self) -> None:
        """Until nothing more is delivered; call it after the session was closed, which ends all waiting."""
        for thread in self._threads:
            self._join(thread)

    def _join(self, thread: threading.Thread) -> None:
        if thread is not threading.current_thread():
            thread.join()

    def _look(self) -> None:
        looks = 0
        while not self._ended.is_set():
            time.sleep(PERIOD)  # a tenth of what waiting for the end itself costs
            looks += 1
            for subscriber in self._subscribers:
                if subscriber.haste is Haste.SOON or looks % PATIENCE == 0:
                    sample = subscriber.channel.try_recv()
                    if sample is not None:
                        self._take(subscriber, sample)

    def _await(self, subscriber: _Subscriber) -> None:
        with contextlib.suppress(self._closed):
            while not self._ended.is_set():
                self._take(subscriber, subscriber.channel.recv())
                time.sleep(PERIOD)  # so that a whole fleet comes in batches

    def _take(self, subscriber: _Subscriber, sample: Any) -> None:
        """All that waits, beginning with `sample`."""
        newest: dict[object, tuple[str, Any]] = {}
        while sample is not None:
            key = str(sample.key_expr)
            newest[len(newest) if subscriber.each_counts else key] = (key, sample.payload)
            sample = subscriber.channel.try_recv()
        for key, payload in newest.values():
            subscriber.deliver(key, payload.to_bytes())
