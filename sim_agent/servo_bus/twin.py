"""A robot's servos, emulated: what a real robot's wiring leads to."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Protocol

from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.servos.port import ServoPort
from robot_agent.hardware.sources import InertialSource, PowerSource
from robot_agent.hardware.wiring import Wiring
from sim_agent.servo_bus.bus import EmulatedBus
from sim_agent.servo_bus.pseudo_terminal import PseudoTerminal
from sim_agent.servo_bus.servo import EmulatedServo
from sim_agent.servo_bus.virtual_port import VirtualPort
from sim_agent.servo_bus.wire import VirtualLineClock

KIND = "EMULATED BUS"


class TurnedJoints(Protocol):
    def advance(self, now_ns: int) -> None:
        """Move to this time of the bus under the servos' orders, and let the servos feel it."""
        ...


class TwinServos:
    """Emulated buses by name. `turning` makes what the servos, in joint order, turn."""

    def __init__(
        self,
        wiring: Wiring,
        turning: Callable[[Sequence[EmulatedServo]], TurnedJoints],
        *,
        seed: int = 0,
        adapter_latency: float = 1e-3,
    ) -> None:
        self.wiring = wiring
        self.servos = [EmulatedServo(servo, model) for servo, model in zip(wiring.ids, wiring.models, strict=True)]
        self.joints = turning(self.servos)
        self.buses = {
            bus.name: EmulatedBus(
                [self.servos[joint] for joint in wiring.joints_of(bus.name)],
                baud=bus.baud,
                adapter_latency=adapter_latency,
                seed=seed + number,
                advance=self.joints.advance,
            )
            for number, bus in enumerate(wiring.config.buses)
        }

    def in_process(
        self, clock: VirtualLineClock, *, imu: InertialSource | None = None, power: PowerSource | None = None
    ) -> tuple[HardwareBody, dict[str, VirtualPort]]:
        """A body that talks to the servos by function calls, and its ports."""
        ports = {name: VirtualPort(bus, clock, name) for name, bus in self.buses.items()}
        handed: dict[str, ServoPort] = dict(ports)
        return HardwareBody(self.wiring, handed, clock, kind=KIND, imu=imu, power=power), ports


class TwinTerminals:
    """The buses of `servos` on pseudo-terminals under the names of the wiring, while in the `with` block."""

    def __init__(self, servos: TwinServos, *, paced: bool = True) -> None:
        self.servos = servos
        ports = {bus.name: bus.port for bus in servos.wiring.config.buses}
        # The buses' threads move one and the same robot.
        lock = threading.Lock()
        self.terminals = {
            name: PseudoTerminal(bus, Path(ports[name]), paced=paced, lock=lock) for name, bus in servos.buses.items()
        }

    def __enter__(self) -> TwinTerminals:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for terminal in self.terminals.values():
            terminal.close()
