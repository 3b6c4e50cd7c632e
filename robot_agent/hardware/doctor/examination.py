"""All checks of a robot in the order in which one explains the next, from the wire to the battery."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from robot_agent.hardware.cameras.source import StereoSource
from robot_agent.hardware.doctor.adapter import USB_SERIAL, judge_adapter
from robot_agent.hardware.doctor.bus_scan import ask_everybody, judge_bus
from robot_agent.hardware.doctor.camera_check import CHECK as CAMERAS
from robot_agent.hardware.doctor.camera_check import judge_cameras
from robot_agent.hardware.doctor.cycle_check import judge_cycles
from robot_agent.hardware.doctor.finding import Finding, Verdict, not_tested
from robot_agent.hardware.doctor.power_check import CHECK as POWER
from robot_agent.hardware.doctor.power_check import judge_power
from robot_agent.hardware.doctor.relay_check import CHECK as RELAY
from robot_agent.hardware.doctor.relay_check import judge_relay
from robot_agent.hardware.doctor.servo_check import (
    ServoState,
    judge_readiness,
    judge_return_delay,
    judge_supply,
    make_ready,
)
from robot_agent.hardware.doctor.still_check import CHECK as STILL
from robot_agent.hardware.doctor.still_check import judge_imu
from robot_agent.hardware.doctor.watchdog_check import CHECK as WATCHDOG
from robot_agent.hardware.doctor.watchdog_check import judge_watchdog
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.power_monitor import PowerMonitor
from robot_agent.hardware.servos.port import LineClock, ServoPort
from robot_agent.hardware.sources import InertialSource
from robot_agent.hardware.wiring import Wiring
from weaver_shared.config.hardware import GenicamCameras
from weaver_shared.config.safety import SafetyLimits
from weaver_shared.errors import ResourceError, WeaverError

Opened = ServoPort | ResourceError
"""A port, or why there is none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Examination:
    """What is there to be looked at. Nothing moves unless `hung_up`: then torque comes on for the watchdogs' test."""

    wiring: Wiring
    ports: Mapping[str, Opened]  # by name of the bus
    clock: LineClock
    imu: InertialSource | ResourceError | None = None  # None: the wiring names none
    power: PowerMonitor | ResourceError | None = None
    cycles: int = 1000
    seconds: float = 5.0  # to listen to the IMU, and to the power monitor
    hung_up: bool = False
    lying: bool = False  # on its belly: the motors' relay may be opened
    cameras: StereoSource | WeaverError | None = None
    adapters: Path = USB_SERIAL

    def run(self) -> Iterator[Finding]:
        """Findings as they come."""
        wiring, clock = self.wiring, self.clock
        open_ports: dict[str, ServoPort] = {}
        for bus, port in self.ports.items():
            if isinstance(port, ResourceError):
                yield _unopened(f"port of bus {bus}", port)
            else:
                open_ports[bus] = port
                yield judge_adapter(bus, port.port_name, self.adapters)
        answers = ask_everybody(open_ports, clock, wiring.config.servos.answer_margin)
        for bus in open_ports:
            yield judge_bus(wiring, bus, answers[bus])
        state = make_ready(wiring, open_ports)
        yield judge_return_delay(wiring, state)
        yield judge_supply(wiring, state, SafetyLimits())
        yield judge_readiness(state)
        yield judge_cycles(wiring, open_ports, clock, state.ready, self.cycles)
        yield self._watchdog(open_ports, state)
        yield self._imu()
        yield self._power()
        yield self._relay(open_ports, state)
        yield self._cameras()

    def _watchdog(self, ports: Mapping[str, ServoPort], state: ServoState) -> Finding:
        if not state.ready.all():
            return not_tested(WATCHDOG, "not every servo is ready", "mend what is said above")
        if state.holding:
            return not_tested(WATCHDOG, "servos hold with torque", "let the robot down and switch torque off")
        if not self.hung_up:
            return not_tested(WATCHDOG, "torque has to come on for it", "hang the robot up, then add --hung-up")
        body = HardwareBody(self.wiring, ports, self.clock)
        body.prepare()
        return judge_watchdog(body, self.clock, self.wiring.config.servos.watchdog)

    def _relay(self, ports: Mapping[str, ServoPort], state: ServoState) -> Finding:
        if not isinstance(self.power, PowerMonitor):
            return not_tested(RELAY, "the power monitor switches it, and there is none")
        if state.holding:
            return not_tested(RELAY, "servos hold with torque", "let the robot down and switch torque off")
        if not self.lying:
            return not_tested(RELAY, "the servos lose their power for it", "let the robot lie down, then add --lying")
        return judge_relay(self.power, ports, self.clock, self.wiring.config.servos.answer_margin)

    def _cameras(self) -> Finding:
        if self.cameras is None:
            return not_tested(CAMERAS, "not connected: the wiring file names none")
        if isinstance(self.cameras, WeaverError):
            return Finding(check=CAMERAS, verdict=Verdict.WRONG, found=str(self.cameras), fix="check power and cables")
        config = self.wiring.config.cameras
        rate = config.rate if isinstance(config, GenicamCameras) else None
        return judge_cameras(self.cameras, rate, self.clock, self.seconds)

    def _imu(self) -> Finding:
        if self.imu is None:
            return not_tested(STILL, "not connected: the wiring file names none")
        if isinstance(self.imu, ResourceError):
            return _unopened(STILL, self.imu)
        return judge_imu(self.imu, self.wiring.robot.imu, self.clock, self.seconds)

    def _power(self) -> Finding:
        if self.power is None:
            return not_tested(POWER, "not connected: the wiring file names none")
        if isinstance(self.power, ResourceError):
            return _unopened(POWER, self.power)
        return judge_power(self.power, SafetyLimits(), self.clock, self.seconds)


def _unopened(check: str, error: ResourceError) -> Finding:
    return Finding(
        check=check,
        verdict=Verdict.WRONG,
        found=str(error),
        fix="plug it in, take its name from /dev/serial/by-id, end the program that has it, or join the group dialout",
    )
