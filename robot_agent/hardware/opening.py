"""From a wiring file to open ports, and to a body on them."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path

from robot_agent.hardware.emulated_clock import EmulatedClock
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.imu import gx3, mip
from robot_agent.hardware.imu.punctual import PunctualImu
from robot_agent.hardware.imu.stream import MicroStrainImu, gx3_imu, gx5_imu
from robot_agent.hardware.power_monitor import BAUD, PowerMonitor
from robot_agent.hardware.serial_line import SerialLine
from robot_agent.hardware.servos.port import LineClock, MonotonicLineClock, SerialPort, ServoPort
from robot_agent.hardware.sources import InertialSource, PowerSource
from robot_agent.hardware.wiring import Wiring
from weaver_shared.config.hardware import ImuLine, PowerLine, ServoBus

EMULATED = "EMULATED BUS"
BITS_PER_BYTE = 10  # on a serial line, with start and stop


def open_robot(wiring: Wiring) -> HardwareBody:
    """Everything that a wiring names, prepared: the robot that is there, or an emulated one that says so.

    Raises ResourceError where something is taken, missing or not what it has to be.
    """
    config = wiring.config
    with ExitStack() as opened:
        clock: LineClock = EmulatedClock(Path(config.emulated.clock)) if config.emulated else MonotonicLineClock()
        imu = open_punctual_imu(config.imu, wiring.robot.imu.rate, clock) if config.imu else None
        power = open_power(config.power) if config.power else None
        for source in (imu, power):
            if source is not None:
                opened.callback(source.close)
        body = open_body(wiring, kind=EMULATED if config.emulated else "REAL", imu=imu, power=power, clock=clock)
        opened.callback(body.close)
        body.prepare()
        opened.pop_all()
    return body


def open_body(
    wiring: Wiring,
    *,
    kind: str = "REAL",
    imu: InertialSource | None = None,
    power: PowerSource | None = None,
    clock: LineClock | None = None,
) -> HardwareBody:
    """A body on the serial ports of a wiring, not yet prepared. Raises ResourceError where one is taken or missing."""
    ports: dict[str, ServoPort] = {}
    try:
        for bus in wiring.config.buses:
            ports[bus.name] = open_port(wiring, bus)
    except BaseException:
        for opened in ports.values():
            opened.closePort()
        raise
    return HardwareBody(wiring, ports, clock or MonotonicLineClock(), kind=kind, imu=imu, power=power)


def open_port(wiring: Wiring, bus: ServoBus) -> SerialPort:
    """The adapter of a bus. Raises ResourceError where it is taken or missing."""
    port = SerialPort(bus.port, bus.baud, answer_margin=wiring.config.servos.answer_margin)
    port.open()
    return port


def open_imu(line: ImuLine, rate: float) -> MicroStrainImu:
    """The IMU on a serial line, sending `rate` Hz. Raises ResourceError where the port is taken or missing."""
    return _imu_on(SerialLine(line.port, line.baud), line, rate)


def open_punctual_imu(line: ImuLine, rate: float, clock: LineClock) -> PunctualImu:
    """The same, heard by a thread of its own on this clock."""
    opened = SerialLine(line.port, line.baud)
    return PunctualImu(_imu_on(opened, line, rate), opened, clock.now_ns)


def open_power(line: PowerLine) -> PowerMonitor:
    """The power monitor. Raises ResourceError where the port is taken or missing."""
    return PowerMonitor(SerialLine(line.port, BAUD))


def _imu_on(opened: SerialLine, line: ImuLine, rate: float) -> MicroStrainImu:
    make, record = {"gx3": (gx3_imu, gx3.LENGTH), "gx5": (gx5_imu, mip.LENGTH)}[line.kind]
    on_wire = record * BITS_PER_BYTE / line.baud
    return make(opened, round(rate), delay=on_wire if line.delay is None else line.delay)
