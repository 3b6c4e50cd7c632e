"""How far a page is behind what it was sent, by its own account.

Between console and page lie buffers of megabytes: a page too busy to read, or behind a narrow way, would be shown, much
later, values that look new. So no more is sent than a page takes in good time; what it misses is replaced by the newest
when it is ready.
"""

from __future__ import annotations

from collections import deque

MOST_ON_THE_WAY = 8
"""Frames sent and not yet taken: 30 a second still reach a page that takes them every 0.1 s, 0.15 s away."""

LEAST_ROOM, MOST_ROOM = 8 * 1024, 256 * 1024
"""Bytes of tiles and pictures on the way: one tile at least, or they would never come."""

PROMPT, LATE = 0.25, 0.5
"""s from sending to taking: below the first there may be more on the way, above the second less."""


class Pace:
    """Times are s of any one clock."""

    def __init__(self) -> None:
        self._reports = False
        self._on_the_way: deque[tuple[float, int]] = deque()  # when, and bytes of tiles and pictures
        self._bulk = 0
        self._most = MOST_ROOM // 4

    @property
    def ready(self) -> bool:
        """Whether more values may be sent. Always, to a page that never reports."""
        return not self._reports or len(self._on_the_way) < MOST_ON_THE_WAY

    @property
    def room(self) -> int:
        """Bytes of tiles and pictures that may be sent now."""
        return MOST_ROOM if not self._reports else max(0, self._most - self._bulk)

    def sent(self, now: float, bulk: int = 0) -> None:
        """A frame with so many bytes of tiles and pictures has gone."""
        self._on_the_way.append((now, bulk))
        self._bulk += bulk
        if not self._reports and len(self._on_the_way) > MOST_ON_THE_WAY:
            self._bulk -= self._on_the_way.popleft()[1]

    def taken(self, now: float, frames: int = 1) -> None:
        """The page has dealt with so many of the frames on the way, the oldest ones."""
        self._reports = True
        for _ in range(min(frames, len(self._on_the_way))):
            self._take(now)

    def _take(self, now: float) -> None:
        when, bulk = self._on_the_way.popleft()
        self._bulk -= bulk
        if now - when > LATE:
            self._most = max(LEAST_ROOM, self._most // 2)
        elif now - when < PROMPT and 2 * bulk > self._most:
            self._most = min(MOST_ROOM, 2 * self._most)
