"""Keeps the time of an emulated robot where its programs find it."""

from __future__ import annotations

import mmap
import time
from pathlib import Path

from robot_agent.hardware.emulated_clock import COUNT, LAYOUT, TICK_NS


class TwinTime:
    """Goes on from where an emulator before it has ended, so that nobody's clock runs backwards."""

    def __init__(self, path: Path) -> None:
        if not path.exists() or path.stat().st_size != LAYOUT.size:
            path.write_bytes(LAYOUT.pack(0, 0, time.monotonic_ns(), 0))
        with path.open("r+b") as file:
            self._map = mmap.mmap(file.fileno(), LAYOUT.size)
        self._count: int
        self._ended_ns: int
        self._at_ns: int
        self._count, self._ended_ns, self._at_ns, _ = LAYOUT.unpack_from(self._map)
        self.begun_ns = self._ended_ns + TICK_NS
        """Of this emulator; a full tick after all that was ever told."""
        self.tick(self.begun_ns)

    def tick(self, ended_ns: int) -> None:
        """A tick of physics has ended at this time of the robot's."""
        self._count += 1
        self._ended_ns, self._at_ns = ended_ns, time.monotonic_ns()
        # Between its two counts a reader sees whether it was read half written. Never by `pack_into`: that fills with
        # zeros first, and a clock that is 0 for a moment stands still, or jumps, for whoever looks just then.
        record = LAYOUT.pack(self._count, ended_ns, self._at_ns, self._count)
        for part in (slice(0, COUNT), slice(COUNT, LAYOUT.size - COUNT), slice(LAYOUT.size - COUNT, LAYOUT.size)):
            self._map[part] = record[part]

    def now_ns(self) -> int:
        return self._ended_ns + min(time.monotonic_ns() - self._at_ns, TICK_NS)
