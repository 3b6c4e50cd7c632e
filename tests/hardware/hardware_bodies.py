"""What hardware tests share: orders to joints, and a robot whose servos are emulated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_agent.body import JointTargets, Trouble
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.wiring import Wiring
from sim_agent.model import sitting_joints
from sim_agent.sensor_lines import TwinSensors
from sim_agent.sensors import InertialSensor
from sim_agent.servo_bus.twin import TwinServos
from sim_agent.servo_bus.virtual_port import VirtualPort
from sim_agent.servo_bus.wire import VirtualLineClock
from weaver_shared.config.hardware import ServoSettings
from weaver_shared.messages import Proprioception
from weaver_shared.robots import RobotDescription

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


class KinematicBody:
    """A body without physics: its joints go where they are told, its IMU lies still, its battery is full."""

    kind = "SIM"

    def __init__(self, robot: RobotDescription) -> None:
        self.robot = robot
        self.holding = False
        self._position = sitting_joints(robot)
        self._velocity = np.zeros(robot.joint_count)
        self._targets: JointTargets | None = None
        self._imu = InertialSensor(robot.imu, np.random.default_rng(1))
        self._imu.begin(np.eye(3), np.zeros(3))
        self._stamp_ns = 0

    def wait_next(self) -> int:
        if self._targets is not None:
            # Who has no torque stays where it is.
            told = np.where(self._targets.torque_limit > 0.0, self._targets.position, self._position)
            moved = np.clip(0.5 * (told - self._position), -0.047, 0.047)
            self._position = self._position + moved
            self._velocity = moved / 0.01
        for part in (5_000_000, 10_000_000):
            self._imu.sample(self._stamp_ns + part, np.eye(3), np.zeros(3))
        self._stamp_ns += 10_000_000
        return self._stamp_ns

    def read(self) -> Proprioception:
        return Proprioception(
            stamp_ns=self._stamp_ns,
            joint_position=self._position,
            joint_velocity=self._velocity,
            joint_torque=np.zeros(self.robot.joint_count),
            joint_valid=np.ones(self.robot.joint_count, dtype=np.bool_),
            joint_temperature=np.full(self.robot.joint_count, 30.0),
            foot_contact=np.ones(self.robot.leg_count, dtype=np.bool_),
            imu=self._imu.take(),
            battery_voltage=27.0,
            supply_current=3.0,
            motor_power=50.0,
        )

    def write(self, targets: JointTargets) -> None:
        self._targets = targets

    def findings(self) -> tuple[Trouble, ...]:
        return ()

    def joint_faults(self) -> tuple[str, ...]:
        return ()

    def close(self) -> None: ...
