"""A serial port that is a function call away and whose time is a variable: tests of hardware code without waiting."""

# ruff: noqa: N802 - the names are the SDK's
from __future__ import annotations

from collections.abc import Sequence

from robot_agent.hardware.servos.port import PortLostError
from sim_agent.servo_bus.wire import Answering, WaitingPort, Wire
from weaver_shared.clock import SimulatedClock


class VirtualPort(WaitingPort):
    """The SDK's port class on an emulated bus; waiting for an answer moves the clock instead of the sun."""

    def __init__(self, bus: Answering, clock: SimulatedClock, name: str = "emulated") -> None:
        super().__init__(name)
        self.bus = bus
        self.wire = Wire(bus)
        self.clock = clock
        self.plugged = True
        self._here = b""
        self.questions: list[bytes] = []
        """Everything that was written, for tests that look at the bytes."""
        self.setBaudRate(self.baudrate)

    def setBaudRate(self, baudrate: int) -> bool:
        self.baudrate = baudrate
        self.tx_time_per_byte = 1e4 / baudrate  # ms
        self.is_open = True
        return True

    def closePort(self) -> None:
        self.is_open = False

    def clearPort(self) -> None:
        self._arrive()
        self._here = b""

    def getBytesAvailable(self) -> int:
        self._arrive()
        return len(self._here)

    def readPort(self, length: int) -> bytes:
        self._check()
        self._arrive()
        taken, self._here = self._here[:length], self._here[length:]
        return taken

    def writePort(self, packet: Sequence[int]) -> int:
        self._check()
        data = bytes(packet)
        self.questions.append(data)
        self.wire.put(data, self.clock.now_ns())
        return len(data)

    def send(self, data: bytes) -> None:
        self._check()
        self.clearPort()
        self.writePort(data)

    def receive(self) -> bytes:
        return self.readPort(self.getBytesAvailable())

    def reopen(self) -> bool:
        self.is_using = False
        return self.plugged

    def _arrive(self) -> None:
        self._here += self.wire.arrived(self.clock.now_ns())

    def _check(self) -> None:
        if not self.plugged:
            raise PortLostError("Input/output error")
