"""A one-place mailbox: the newest value wins, so a slow reader never slows the writer."""

import threading
from typing import Generic, TypeVar

T = TypeVar("T")


class LatestSlot(Generic[T]):
    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._value: T | None = None
        self._fresh = False
        self._overwritten = 0

    def put(self, value: T) -> None:
        with self._changed:
            self._overwritten += self._fresh
            self._value = value
            self._fresh = True
            self._changed.notify_all()

    def take(self, timeout: float = 0.0) -> T | None:
        """The newest value not yet taken, waiting up to `timeout` s for one; None if there is none."""
        with self._changed:
            if not self._fresh and timeout > 0.0:
                self._changed.wait_for(lambda: self._fresh, timeout)
            if not self._fresh:
                return None
            self._fresh = False
            return self._value

    def peek(self) -> T | None:
        """The newest value, taken or not."""
        with self._changed:
            return self._value

    @property
    def overwritten(self) -> int:
        """How many values nobody took before the next one came."""
        with self._changed:
            return self._overwritten
