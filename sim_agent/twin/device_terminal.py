"""A device that talks by itself on a pseudo-terminal, in real time."""

from __future__ import annotations

import os
import select
import threading
import tty
from pathlib import Path

from sim_agent.sensor_lines import Device

_POLL = 0.05
"""s after which the thread looks whether it is to end."""


class DeviceTerminal:
    """Obeys what is written to `link` in a thread; `put` sends. What nobody reads is lost, as on a serial line."""

    def __init__(self, link: Path, device: Device) -> None:
        self._device = device
        self.mute = False
        self.noise = b""
        """Sent before what the device says next."""
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(self._slave))
        self._link = link
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    @property
    def openings(self) -> int:
        return 1

    def put(self, data: bytes) -> None:
        if self.mute or not data:
            return
        data, self.noise = self.noise + data, b""
        try:
            os.write(self._master, data)
        except BlockingIOError:
            return

    def receive(self, now_ns: int) -> bytes:
        """The near end is in another process."""
        return b""

    def send(self, data: bytes) -> bool:
        return False

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._link.unlink(missing_ok=True)
        os.close(self._master)
        os.close(self._slave)

    def _serve(self) -> None:
        while not self._ending.is_set():
            if select.select([self._master], [], [], _POLL)[0]:
                self.put(self._device.obey(os.read(self._master, 4096)))
