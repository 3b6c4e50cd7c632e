"""A pseudo-terminal in lock step: bytes go through the kernel, and time is a variable that waits for them."""

from __future__ import annotations

import array
import fcntl
import os
import select
import termios
import time
import tty
from pathlib import Path

from weaver_shared.errors import ResourceError

PATIENCE = 10.0
"""s of real time for bytes to get through the kernel on however busy a computer."""
FULL = 4095
"""Bytes that a terminal keeps ready for who reads it; further ones follow when it has read."""


class SteppedTerminal:
    """Both ends of a terminal under the stable name `link`; this is the far one."""

    def __init__(self, link: Path) -> None:
        self.link = link
        self._far, self._near = os.openpty()
        tty.setraw(self._near)
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(self._near))

    def take(self, count: int) -> bytes:
        """The `count` bytes that were written at the near end; waits until they are here."""
        data = b""
        while len(data) < count:
            data += os.read(self._far, count - len(data))
        return data

    def say(self, data: bytes) -> None:
        """Returns when the near end can read them."""
        expected = min(self.unread() + len(data), FULL)
        os.write(self._far, data)
        deadline = time.monotonic() + PATIENCE
        while self.unread() < expected:
            if time.monotonic() > deadline:
                raise ResourceError(f"terminal {self.link} does not pass on what is written to it")
            # Sleeping lets the kernel's worker have the processor, where yielding would let in everybody else.
            select.select([self._near], [], [], PATIENCE if self.unread() == 0 else 0.0)

    def unread(self) -> int:
        """Bytes that the near end can read."""
        count = array.array("i", [0])
        fcntl.ioctl(self._near, termios.FIONREAD, count)
        return count[0]

    def close(self) -> None:
        self.link.unlink(missing_ok=True)
        for end in (self._far, self._near):
            os.close(end)
