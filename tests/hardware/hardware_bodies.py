"""What hardware tests share: orders to joints, and a robot whose servos are emulated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_agent.body import JointTargets
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.wiring import Wiring
from sim_agent.sensor_lines import TwinSensors
from sim_agent.servo_bus.twin import TwinServos
from sim_agent.servo_bus.virtual_port import VirtualPort
from sim_agent.servo_bus.wire import VirtualLineClock
from weaver_shared.config.hardware import ServoSettings

STAND = 0.4  # m above the ground
PATIENT = ServoSettings(answer_margin=1.0, watchdog=2.5, start_time=0.1, start_speed=8.0)
"""For terminals on a busy computer: answers come when its scheduler lets them."""
BRISK = ServoSettings(start_time=0.1, start_speed=8.0)


@dataclass
class Twin:
    """A hardware body in process, with the servos, sensors, ports and clock behind it."""

    body: HardwareBody
    servos: TwinServos
    sensors: TwinSensors
    ports: dict[str, VirtualPort]
    clock: VirtualLineClock
    wiring: Wiring
    wanted: np.ndarray

    def run(self, ticks: int, *, torque: float = 6.0) -> None:
        for _ in range(ticks):
            self.body.wait_next()
            self.body.write(order(self.wanted, torque=torque))


def order(position: np.ndarray, *, torque: float = 6.0, on: bool = True) -> JointTargets:
    return JointTargets(stamp_ns=0, position=position, torque_limit=np.full(position.size, torque), torque_on=on)
