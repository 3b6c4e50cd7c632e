"""The driver's own serial ports on emulated devices in lock step: opened, locked, written and read as real ones are."""

# ruff: noqa: N802 - the names are the SDK's
from __future__ import annotations

from collections.abc import Callable, Sequence

from robot_agent.hardware.serial_line import SerialLine
from robot_agent.hardware.servos.port import SerialPort
from sim_agent.sensor_lines import Device
from sim_agent.servo_bus.bus import EmulatedBus
from sim_agent.servo_bus.stepped_terminal import SteppedTerminal
from sim_agent.servo_bus.wire import WaitingPort, Wire
from weaver_shared.clock import SimulatedClock


class SteppedPort(WaitingPort, SerialPort):
    """An emulated bus behind a terminal. What is written is on the bus at once; answers come at their times."""

    def __init__(self, bus: EmulatedBus, terminal: SteppedTerminal, baud: int, clock: SimulatedClock) -> None:
        super().__init__(str(terminal.link), baud)
        self.wire = Wire(bus)
        self.clock = clock
        self._terminal = terminal
        self.open()

    def writePort(self, packet: Sequence[int]) -> int:
        count = super().writePort(packet)
        self.wire.put(self._terminal.take(count), self.clock.now_ns())
        return count

    def clearPort(self) -> None:
        self._arrive()
        super().clearPort()

    def getBytesAvailable(self) -> int:
        self._arrive()
        return self._terminal.unread()

    def readPort(self, length: int) -> bytes:
        self._arrive()
        return bytes(self._serial().read(length))

    def receive(self) -> bytes:
        self._arrive()
        return super().receive()

    def _arrive(self) -> None:
        if data := self.wire.arrived(self.clock.now_ns()):
            self._terminal.say(data)


class SteppedLine(SerialLine):
    """A device that talks by itself behind a terminal: `put` is its end. `go_on` lets it live up to a time."""

    def __init__(self, device: Device, terminal: SteppedTerminal, baud: int, go_on: Callable[[int], None]) -> None:
        self._device = device
        self._terminal = terminal
        self._go_on = go_on
        super().__init__(str(terminal.link), baud)

    def receive(self, now_ns: int) -> bytes:
        self._go_on(now_ns)
        return super().receive(now_ns)

    def put(self, data: bytes) -> None:
        if data:
            self._terminal.say(data)

    def send(self, data: bytes) -> bool:
        sent = super().send(data)
        if sent:
            self.put(self._device.obey(self._terminal.take(len(data))))
        return sent
