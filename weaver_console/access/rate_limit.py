"""So many in so many seconds and no more, for each who asks."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable

MOST_KEYS = 10_000
"""Whoever asks from ever new addresses makes the oldest forgotten, not the memory full."""


class RateLimit:
    """A bucket for each key that holds `burst` and fills by `rate` a second."""

    def __init__(self, *, rate: float, burst: float, now: Callable[[], float]) -> None:
        self._rate, self._burst, self._now = rate, burst, now
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()  # left, and when

    def exhausted(self, key: str) -> bool:
        return self._left(key) < 1.0

    def spend(self, key: str) -> bool:
        """Take one; False when there is none left."""
        left = self._left(key)
        if left < 1.0:
            return False
        self._buckets[key] = (left - 1.0, self._now())
        self._buckets.move_to_end(key)
        while len(self._buckets) > MOST_KEYS:
            self._buckets.popitem(last=False)
        return True

    def _left(self, key: str) -> float:
        left, when = self._buckets.get(key, (self._burst, self._now()))
        return min(self._burst, left + self._rate * max(0.0, self._now() - when))
