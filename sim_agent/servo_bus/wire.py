"""What is on its way between a port and an emulated bus when time is a variable."""

# ruff: noqa: N802 - the names are the SDK's
from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from dynamixel_sdk import PortHandler

from robot_agent.hardware.servos.port import ServoPort
from sim_agent.servo_bus.bus import Reply
from weaver_shared.clock import SimulatedClock

_NS_PER_MS = 1_000_000


class Answering(Protocol):
    def transmit(self, data: bytes, now_ns: int) -> list[Reply]:
        """The answers to bytes on the line, each with the time at which the computer has it."""
        ...


class Wire:
    """A bus, and its answers that have not arrived yet."""

    def __init__(self, bus: Answering) -> None:
        self.bus = bus
        self._coming: list[Reply] = []

    def put(self, data: bytes, now_ns: int) -> None:
        """Bytes go onto the line."""
        self._coming += self.bus.transmit(data, now_ns)

    def arrived(self, now_ns: int) -> bytes:
        """Answers that have reached the computer since the last call."""
        here = b"".join(reply.data for reply in self._coming if reply.arrives_ns <= now_ns)
        self._coming = [reply for reply in self._coming if reply.arrives_ns > now_ns]
        return here

    def next_arrival_ns(self, otherwise_ns: int) -> int:
        return min((reply.arrives_ns for reply in self._coming), default=otherwise_ns)


class WaitingPort(PortHandler):  # type: ignore[misc]
    """A port whose waiting moves the clock. `getBytesAvailable` says what has come and was not taken."""

    wire: Wire
    clock: SimulatedClock

    def getCurrentTime(self) -> float:
        return self.clock.now_ns() / _NS_PER_MS

    def isPacketTimeout(self) -> bool:
        """Whoever asks has found nothing to read: go on to the next answer, or to the end of the wait."""
        over_ns = round((self.packet_start_time + self.packet_timeout) * _NS_PER_MS) + 1
        if not self.getBytesAvailable():
            self.clock.sleep_until(min(self.wire.next_arrival_ns(over_ns), over_ns))
        return super().isPacketTimeout()  # type: ignore[no-any-return]

    def next_arrival_ns(self, otherwise_ns: int) -> int:
        """When the next answer is here; now if one already is."""
        return self.clock.now_ns() if self.getBytesAvailable() else self.wire.next_arrival_ns(otherwise_ns)


class VirtualLineClock(SimulatedClock):
    """Waits for answers by going on to the first of them."""

    def wait_for_answer(self, ports: Sequence[ServoPort], deadline_ns: int) -> None:
        arrivals = [port.next_arrival_ns(deadline_ns) for port in ports if isinstance(port, WaitingPort)]
        self.sleep_until(min([*arrivals, deadline_ns]))
