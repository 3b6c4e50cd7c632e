"""From a wiring file to open ports, and to a body on them."""

from __future__ import annotations

from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.imu.stream import MicroStrainImu, gx3_imu, gx5_imu
from robot_agent.hardware.power_monitor import BAUD, PowerMonitor
from robot_agent.hardware.serial_line import SerialLine
from robot_agent.hardware.servos.port import MonotonicLineClock, SerialPort, ServoPort
from robot_agent.hardware.sources import InertialSource, PowerSource
from robot_agent.hardware.wiring import Wiring
from weaver_shared.config.hardware import ImuLine, PowerLine, ServoBus


def open_body(
    wiring: Wiring, *, kind: str = "REAL", imu: InertialSource | None = None, power: PowerSource | None = None
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
    return HardwareBody(wiring, ports, MonotonicLineClock(), kind=kind, imu=imu, power=power)


def open_port(wiring: Wiring, bus: ServoBus) -> SerialPort:
    """The adapter of a bus. Raises ResourceError where it is taken or missing."""
    port = SerialPort(bus.port, bus.baud, answer_margin=wiring.config.servos.answer_margin)
    port.open()
    return port


def open_imu(line: ImuLine, rate: float) -> MicroStrainImu:
    """The IMU on a serial line, sending `rate` Hz. Raises ResourceError where the port is taken or missing."""
    make = {"gx3": gx3_imu, "gx5": gx5_imu}[line.kind]
    return make(SerialLine(line.port, line.baud), round(rate))


def open_power(line: PowerLine) -> PowerMonitor:
    """The power monitor. Raises ResourceError where the port is taken or missing."""
    return PowerMonitor(SerialLine(line.port, BAUD))
