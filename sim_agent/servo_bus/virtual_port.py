"""A serial port that is a function call away and whose time is a variable: tests of hardware code without waiting."""

# ruff: noqa: N802 - the names are the SDK's
from __future__ import annotations

from collections.abc import Sequence

from dynamixel_sdk import PortHandler

from robot_agent.hardware.servos.port import PortLostError, ServoPort
from sim_agent.servo_bus.bus import EmulatedBus, Reply
from weaver_shared.clock import SimulatedClock

_NS_PER_MS = 1_000_000


class VirtualPort(PortHandler):  # type: ignore[misc]
    """The SDK's port class on an emulated bus; waiting for an answer moves the clock instead of the sun."""

    def __init__(self, bus: EmulatedBus, clock: SimulatedClock, name: str = "emulated") -> None:
        super().__init__(name)
        self.bus = bus
        self.clock = clock
        self.plugged = True
        self._coming: list[Reply] = []
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
        self._coming += self.bus.transmit(data, self.clock.now_ns())
        return len(data)

    def getCurrentTime(self) -> float:
        return self.clock.now_ns() / _NS_PER_MS

    def isPacketTimeout(self) -> bool:
        """Whoever asks has found nothing to read: go on to the next answer, or to the end of the wait."""
        over_ns = round((self.packet_start_time + self.packet_timeout) * _NS_PER_MS) + 1
        if not self._here:
            self.clock.sleep_until(min(self.next_arrival_ns(over_ns), over_ns))
        return super().isPacketTimeout()  # type: ignore[no-any-return]

    def send(self, data: bytes) -> None:
        self._check()
        self.clearPort()
        self.writePort(data)

    def receive(self) -> bytes:
        return self.readPort(self.getBytesAvailable())

    def reopen(self) -> bool:
        self.is_using = False
        return self.plugged

    def next_arrival_ns(self, otherwise_ns: int) -> int:
        """When the next answer is here; now if one already is."""
        if self._here:
            return self.clock.now_ns()
        return min((reply.arrives_ns for reply in self._coming), default=otherwise_ns)

    def _arrive(self) -> None:
        now_ns = self.clock.now_ns()
        self._here += b"".join(reply.data for reply in self._coming if reply.arrives_ns <= now_ns)
        self._coming = [reply for reply in self._coming if reply.arrives_ns > now_ns]

    def _check(self) -> None:
        if not self.plugged:
            raise PortLostError("Input/output error")


class VirtualLineClock(SimulatedClock):
    """Waits for answers by going on to the first of them."""

    def wait_for_answer(self, ports: Sequence[ServoPort], deadline_ns: int) -> None:
        arrivals = [port.next_arrival_ns(deadline_ns) for port in ports if isinstance(port, VirtualPort)]
        self.sleep_until(min([*arrivals, deadline_ns]))
