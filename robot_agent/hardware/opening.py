"""From a wiring file to a body on real ports."""

from __future__ import annotations

from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.servos.port import MonotonicLineClock, SerialPort, ServoPort
from robot_agent.hardware.sources import InertialSource, PowerSource
from robot_agent.hardware.wiring import Wiring


def open_body(
    wiring: Wiring, *, kind: str = "REAL", imu: InertialSource | None = None, power: PowerSource | None = None
) -> HardwareBody:
    """A body on the serial ports of a wiring, not yet prepared. Raises ResourceError where one is taken or missing."""
    ports: dict[str, ServoPort] = {}
    try:
        for bus in wiring.config.buses:
            port = SerialPort(bus.port, bus.baud, answer_margin=wiring.config.servos.answer_margin)
            port.open()
            ports[bus.name] = port
    except BaseException:
        for opened in ports.values():
            opened.closePort()
        raise
    return HardwareBody(wiring, ports, MonotonicLineClock(), kind=kind, imu=imu, power=power)
