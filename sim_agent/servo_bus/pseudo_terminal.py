"""An emulated bus on a pseudo-terminal: programs open it as they open a serial adapter."""

from __future__ import annotations

import os
import select
import threading
import time
import tty
from collections.abc import Callable
from pathlib import Path

from sim_agent.servo_bus.bus import EmulatedBus, Reply

_POLL = 0.05
"""s after which the thread looks whether it is to end."""


class PseudoTerminal:
    """Serves `bus` under the stable name `link` until closed; `paced` delivers answers no sooner than a line would."""

    def __init__(
        self,
        bus: EmulatedBus,
        link: Path,
        *,
        paced: bool = True,
        lock: threading.Lock | None = None,
        now_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self.bus = bus
        self.link = link
        self._paced = paced
        self._now_ns = now_ns
        self._lock = lock or threading.Lock()
        self._ends: tuple[int, int] | None = None
        self._thread: threading.Thread | None = None
        self._ending = threading.Event()
        self.plug_in()

    def plug_in(self) -> None:
        """A new terminal under the same name, as an adapter that was pulled out and put back."""
        if self._ends is not None:
            return
        self._ends = os.openpty()
        master, slave = self._ends
        tty.setraw(slave)
        self.link.unlink(missing_ok=True)
        self.link.symlink_to(os.ttyname(slave))
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._serve, args=(master, self._ending), daemon=True)
        self._thread.start()

    def unplug(self) -> None:
        """Both ends close and the name goes; whoever has it open gets input/output errors."""
        if self._ends is None or self._thread is None:
            return
        self._ending.set()
        self._thread.join()
        self.link.unlink(missing_ok=True)
        for end in self._ends:
            os.close(end)
        self._ends = None

    def close(self) -> None:
        self.unplug()

    def _serve(self, master: int, ending: threading.Event) -> None:
        waiting: list[Reply] = []
        while not ending.is_set():
            pause = _POLL
            if waiting:
                pause = min(max(waiting[0].arrives_ns - self._now_ns(), 0) * 1e-9, _POLL)
            if select.select([master], [], [], pause)[0]:
                data = os.read(master, 4096)
                with self._lock:
                    waiting += self.bus.transmit(data, self._now_ns())
            due_ns = self._now_ns()
            ready = [reply for reply in waiting if reply.arrives_ns <= due_ns or not self._paced]
            if ready:
                os.write(master, b"".join(reply.data for reply in ready))
                waiting = waiting[len(ready) :]
