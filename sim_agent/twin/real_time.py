"""The emulated robot in real time: physics tick by tick, its devices on pseudo-terminals, served by a thread each."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from contextlib import ExitStack, closing
from pathlib import Path

from robot_agent.hardware.wiring import Wiring
from sim_agent.body import TICK_NS, SimulatedBody
from sim_agent.sensor_lines import EmulatedGx5, TwinSensors
from sim_agent.servo_bus.body_joints import BodyJoints
from sim_agent.servo_bus.pseudo_terminal import PseudoTerminal
from sim_agent.servo_bus.servo import EmulatedServo
from sim_agent.servo_bus.twin import TwinServos
from sim_agent.twin.device_terminal import DeviceTerminal
from sim_agent.twin.twin_time import TwinTime
from weaver_shared.errors import ConfigurationError
from weaver_shared.messages import Proprioception


class _TickedJoints:
    """Moves with the ticks of physics, not with the packets on the bus: those only read what is."""

    def __init__(self, joints: BodyJoints) -> None:
        self.joints = joints

    def advance(self, now_ns: int) -> None:
        """Nothing: see `RealTimeTwin.tick`."""


class RealTimeTwin:
    """A simulated body behind its devices. `wiring` names the ports; `close` ends the threads and removes them."""

    def __init__(self, wiring: Wiring, body: SimulatedBody, time: TwinTime, *, seed: int = 0) -> None:
        self.body = body
        self.wiring = wiring
        self.time = time
        self._open = ExitStack()
        self._felt: list[tuple[int, Proprioception]] = []
        self.lock = threading.Lock()
        """To be held while servos are meddled with."""
        imu, power = wiring.config.imu, wiring.config.power
        if imu is None or power is None:
            raise ConfigurationError(
                "an emulated robot has an IMU and a power monitor; its wiring has to name their ports"
            )
        ports = {"imu": imu.port, "power": power.port}
        self.lines: dict[str, DeviceTerminal] = {}
        self.sensors = TwinSensors(
            EmulatedGx5(), lambda name, device: self.lines.setdefault(name, DeviceTerminal(Path(ports[name]), device))
        )
        for line in self.lines.values():
            self._open.enter_context(closing(line))
        self.servos = TwinServos(wiring, self._turned, seed=seed)
        self.terminals = {
            bus.name: self._open.enter_context(
                closing(PseudoTerminal(self.servos.buses[bus.name], Path(bus.port), lock=self.lock, now_ns=time.now_ns))
            )
            for bus in wiring.config.buses
        }
        self._stamp_ns: int = time.begun_ns
        self._joints.advance(self._stamp_ns)

    def tick(self) -> int:
        """One tick of 10 ms; returns its time."""
        self._stamp_ns += TICK_NS
        with self.lock:
            self._joints.advance(self._stamp_ns)
        self.time.tick(self._stamp_ns)
        # Not before: what was felt at an instant can not arrive ahead of it.
        felt, self._felt = self._felt, []
        for now_ns, sensed in felt:
            self.sensors.hear(now_ns, sensed)
        return self._stamp_ns

    def close(self) -> None:
        self._open.close()

    def _feel(self, now_ns: int, sensed: Proprioception) -> None:
        self._felt.append((now_ns, sensed))

    def _turned(self, servos: Sequence[EmulatedServo]) -> _TickedJoints:
        self._joints = BodyJoints(servos, self.body, self.wiring, heard=self._feel)
        return _TickedJoints(self._joints)
