"""How far a page is behind what it was sent, by its own account.

Between console and page lie buffers of megabytes: a page too busy to read would be shown, much later, values that look
new. So no more values are sent than a page has taken; what it misses is replaced by the newest when it is ready.
"""

from __future__ import annotations

MOST_ON_THE_WAY = 3
"""Batches sent and not yet taken: 20 a second still reach a page 0.15 s away."""


class Pace:
    def __init__(self) -> None:
        self._reports = False
        self._on_the_way = 0

    @property
    def ready(self) -> bool:
        """Whether more values may be sent. Always, to a page that never reports."""
        return not self._reports or self._on_the_way < MOST_ON_THE_WAY

    def sent(self) -> None:
        self._on_the_way += 1

    def taken(self) -> None:
        self._reports = True
        self._on_the_way = max(0, self._on_the_way - 1)
