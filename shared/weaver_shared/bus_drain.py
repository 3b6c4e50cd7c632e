"""What has come for subscribers, taken in batches by one thread, the newest of each key where only that counts.

Zenoh calls a subscriber back for every message, and each call waits for its turn at the interpreter. Who hears a whole
fleet falls behind for good when it is short of computing time, and then shows what is long past. Here messages
wait outside the interpreter, and what newer ones have replaced is never read.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

PERIOD = 0.002
"""s between two looks at what should be heard at once."""

PATIENCE = 5
"""Looks after which the rest is taken too: tiles, pictures and slow values wait up to 10 ms. Looking at everything
every time cost a tenth of what a console computes."""

ROOM, LOGGED_ROOM = 1024, 8192
"""Messages that wait for a subscriber; beyond, the oldest go."""

Deliver = Callable[[str, bytes], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Subscriber:
    channel: Any
    deliver: Deliver
    each_counts: bool
    prompt: bool


class Drain:
    """`declare` from any thread; `deliver` is called with full key and payload, in the drain's own thread."""

    def __init__(self, declare: Callable[[str, int], Any]) -> None:
        """`declare` makes a Zenoh subscriber of a key pattern that keeps so many messages."""
        self._declare = declare
        self._subscribers: tuple[_Subscriber, ...] = ()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="bus", daemon=True)
        self._thread.start()

    def declare(self, pattern: str, deliver: Deliver, *, each_counts: bool, prompt: bool = True) -> None:
        channel = self._declare(pattern, LOGGED_ROOM if each_counts else ROOM)
        new = _Subscriber(channel=channel, deliver=deliver, each_counts=each_counts, prompt=prompt)
        self._subscribers = (*self._subscribers, new)

    def close(self) -> None:
        self._ended.set()
        if self._thread is not threading.current_thread():
            self._thread.join()

    def _run(self) -> None:
        looks = 0
        while not self._ended.is_set():
            time.sleep(PERIOD)  # a tenth of what waiting for the end itself costs
            looks += 1
            for subscriber in self._subscribers:
                if subscriber.prompt or looks % PATIENCE == 0:
                    sample = subscriber.channel.try_recv()
                    if sample is not None:
                        self._take(subscriber, sample)

    def _take(self, subscriber: _Subscriber, sample: Any) -> None:
        """All that waits, beginning with `sample`."""
        newest: dict[object, tuple[str, Any]] = {}
        while sample is not None:
            key = str(sample.key_expr)
            newest[len(newest) if subscriber.each_counts else key] = (key, sample.payload)
            sample = subscriber.channel.try_recv()
        for key, payload in newest.values():
            subscriber.deliver(key, payload.to_bytes())
