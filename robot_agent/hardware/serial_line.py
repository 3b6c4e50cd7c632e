"""A serial device that talks by itself: never blocks, and is looked for again under its name when it is gone."""

from __future__ import annotations

import contextlib
import select
import termios
import time
from typing import Any, Protocol

import serial

from robot_agent.hardware.servos.port_lock import PortLock
from weaver_shared.errors import ResourceError

_GONE = (OSError, termios.error, serial.SerialException)
_ALL = 65_536
RETRY_NS = 500_000_000


class ByteLine(Protocol):
    def receive(self, now_ns: int) -> bytes:
        """What has come, perhaps nothing; nothing as long as the device is gone."""
        ...

    def send(self, data: bytes) -> bool:
        """False where it could not be sent."""
        ...

    @property
    def openings(self) -> int:
        """How often the line was opened: a device that comes back has forgotten what it was told."""
        ...

    def close(self) -> None: ...


class SerialLine:
    """A device on a serial port for us alone. Raises ResourceError if it can not be opened at the start."""

    def __init__(self, name: str, baud: int) -> None:
        self._name, self._baud = name, baud
        self._serial: Any = None
        self._lock: PortLock | None = None
        self._retry_ns = 0
        self.openings = 0
        self._open()

    def receive(self, now_ns: int) -> bytes:
        if self._serial is None:
            if now_ns < self._retry_ns:
                return b""
            self._retry_ns = now_ns + RETRY_NS
            with contextlib.suppress(ResourceError):
                self._open()
            return b""
        try:
            return bytes(self._serial.read(_ALL))
        except _GONE:
            self.close()
            return b""

    def wait(self, timeout: float) -> None:
        """Until something has come, or `timeout` s are over."""
        device = self._serial
        try:
            if device is not None:
                select.select([device.fileno()], [], [], timeout)
                return
        except (*_GONE, ValueError, TypeError):
            pass  # closed meanwhile: what follows is no hurry
        time.sleep(timeout)

    def send(self, data: bytes) -> bool:
        if self._serial is None:
            return False
        try:
            self._serial.write(data)
        except _GONE:
            self.close()
            return False
        return True

    def close(self) -> None:
        if self._serial is not None:
            with contextlib.suppress(*_GONE):
                self._serial.close()
            self._serial = None
        if self._lock is not None:
            self._lock.release()
            self._lock = None

    def _open(self) -> None:
        lock = PortLock(self._name)
        lock.take()
        try:
            self._serial = serial.Serial(self._name, self._baud, timeout=0, write_timeout=1.0, exclusive=True)
        except _GONE as error:
            lock.release()
            raise ResourceError(f"port {self._name} can not be opened: {error}") from error
        self._lock = lock
        self.openings += 1
