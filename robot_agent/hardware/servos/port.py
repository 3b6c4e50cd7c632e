"""Serial ports of the servo buses, and the waiting for what comes from them."""

# ruff: noqa: N802 - the names are the SDK's
from __future__ import annotations

import contextlib
import os
import select
import termios
import time
from collections.abc import Sequence
from typing import Any, Protocol

import serial
from dynamixel_sdk import PortHandler

from robot_agent.hardware.servos.port_lock import PortLock
from robot_agent.hardware.servos.registers import BAUD_RATES
from weaver_shared.clock import Clock, MonotonicClock
from weaver_shared.errors import ConfigurationError, ResourceError

_NS_PER_MS = 1_000_000
_ALL = 65_536


class PortLostError(OSError):
    """The port is gone: the adapter was pulled out, or the other end closed."""


class ServoPort(Protocol):
    """A bus as the cyclic exchange uses it; also a port of the SDK. All but `reopen` raise PortLostError."""

    port_name: str

    def send(self, data: bytes) -> None:
        """Forget what has come so far and write."""
        ...

    def receive(self) -> bytes:
        """What has come, perhaps nothing."""
        ...

    def reopen(self) -> bool:
        """Try to open it again under its name."""
        ...

    def closePort(self) -> None: ...


class LineClock(Clock, Protocol):
    def wait_for_answer(self, ports: Sequence[ServoPort], deadline_ns: int) -> None:
        """Return when one of the ports has something to receive, or at the deadline."""
        ...


class SerialPort(PortHandler):  # type: ignore[misc]
    """A serial adapter for us alone. Waits without spinning, by a clock that no wall-clock step moves."""

    def __init__(self, name: str, baud: int, *, answer_margin: float = 0.004) -> None:
        super().__init__(name)
        self.ser: Any = None
        if baud not in BAUD_RATES:
            valid = ", ".join(str(rate) for rate in BAUD_RATES)
            raise ConfigurationError(f"port {name}: servos do not know {baud} bit/s; they know {valid}")
        self.baudrate = baud
        self._margin_ms = answer_margin * 1e3
        self._lock: PortLock | None = None

    def open(self) -> None:
        """Raises ResourceError where somebody else has it or it is not there."""
        lock = PortLock(self.port_name)
        lock.take()
        try:
            self.setupPort(self.baudrate)
        except (OSError, termios.error, serial.SerialException) as error:
            lock.release()
            raise ResourceError(f"port {self.port_name} can not be opened: {error}") from error
        self._lock = lock

    def reopen(self) -> bool:
        self.closePort()
        try:
            self.open()
        except ResourceError:
            return False
        return True

    def closePort(self) -> None:
        """Never raises: the adapter may be gone."""
        if self.ser is not None:
            with contextlib.suppress(OSError, termios.error, serial.SerialException):
                self.ser.close()
            self.ser = None
        self.is_open = self.is_using = False
        if self._lock is not None:
            self._lock.release()
            self._lock = None

    def setupPort(self, cflag_baud: int) -> bool:
        self.ser = serial.Serial(self.port_name, cflag_baud, timeout=0, write_timeout=1.0, exclusive=True)
        # An adapter hands bytes on at once instead of every 16 ms where its driver can; a terminal can not.
        with contextlib.suppress(OSError, ValueError, NotImplementedError):
            self.ser.set_low_latency_mode(True)
        self.is_open = True
        self.tx_time_per_byte = 1e4 / cflag_baud  # ms
        return True

    def getCFlagBaud(self, baudrate: int) -> int:
        return baudrate if baudrate in BAUD_RATES else -1

    def fileno(self) -> int:
        return int(self._serial().fileno())

    def send(self, data: bytes) -> None:
        self.clearPort()
        self.writePort(data)

    def receive(self) -> bytes:
        try:
            # The package's own way asks the kernel three times more. Nothing may mean that the port is gone: it knows.
            return os.read(self.fileno(), _ALL) or bytes(self._serial().read(_ALL))
        except (OSError, termios.error, serial.SerialException) as error:
            raise PortLostError(str(error)) from error

    def clearPort(self) -> None:
        try:
            self._serial().reset_input_buffer()
        except (OSError, termios.error, serial.SerialException) as error:
            raise PortLostError(str(error)) from error

    def writePort(self, packet: Sequence[int]) -> int:
        data = bytes(packet)
        try:
            with contextlib.suppress(BlockingIOError):
                data = data[os.write(self.fileno(), data) :]
            if data:
                self._serial().write(data)
            return len(packet)
        except (OSError, termios.error, serial.SerialException) as error:
            raise PortLostError(str(error)) from error

    def readPort(self, length: int) -> bytes:
        """For the SDK, which asks without pause until its time is over: wait here instead."""
        remaining = (self.packet_start_time + self.packet_timeout - self.getCurrentTime()) * 1e-3
        try:
            select.select([self.fileno()], [], [], min(max(remaining, 0.0), 1.0))
            return bytes(self._serial().read(length))
        except (OSError, ValueError, termios.error, serial.SerialException) as error:
            raise PortLostError(str(error)) from error

    def getCurrentTime(self) -> float:
        return time.monotonic_ns() / _NS_PER_MS

    def setPacketTimeout(self, packet_length: int) -> None:
        self.setPacketTimeoutMillis(self.tx_time_per_byte * packet_length + self._margin_ms)

    def _serial(self) -> serial.Serial:
        if self.ser is None:
            raise PortLostError(f"port {self.port_name} is closed")
        return self.ser


class MonotonicLineClock(MonotonicClock):
    """Real time, and `select` over all ports at once."""

    def wait_for_answer(self, ports: Sequence[ServoPort], deadline_ns: int) -> None:
        remaining = (deadline_ns - self.now_ns()) * 1e-9
        if remaining > 0.0:
            select.select([port for port in ports if isinstance(port, SerialPort)], [], [], remaining)
