"""A simulated robot that is only reached through its servos' bytes: the hardware code as it is, in lock step.

The bus's clock and the simulator's tell the same time: both begin at 0, and a tick of the one is a tick of the other.
"""

from __future__ import annotations

from pathlib import Path

from robot_agent.body import JointTargets
from robot_agent.hardware.imu.stream import gx5_imu
from robot_agent.hardware.power_monitor import PowerMonitor
from robot_agent.hardware.wiring import Wiring
from sim_agent.body import TICK_NS, SimulatedBody
from sim_agent.sensor_lines import EmulatedGx5, TwinSensors
from sim_agent.servo_bus.body_joints import BodyJoints
from sim_agent.servo_bus.twin import KIND, TwinServos
from sim_agent.servo_bus.twin_wiring import twin_wiring
from sim_agent.servo_bus.virtual_port import VirtualLineClock
from sim_agent.worlds import World
from weaver_shared.messages import Proprioception, SceneState, TruthState
from weaver_shared.robots import RobotDescription

NOWHERE = Path("/nowhere")
"""Ports of function calls have no place in the file system."""


class TwinBody:
    """A `robot_agent.body.Body` on emulated servos, IMU and power monitor; truth and scene are the simulator's."""

    kind = KIND

    def __init__(self, robot: RobotDescription, world: World, seed: int) -> None:
        self.robot = robot
        self._simulated = SimulatedBody(robot, world, seed)
        wiring = Wiring(twin_wiring(robot, NOWHERE), robot)
        sensors = TwinSensors(EmulatedGx5())
        servos = TwinServos(
            wiring, lambda servos: BodyJoints(servos, self._simulated, wiring, heard=sensors.hear), seed=seed
        )
        clock = VirtualLineClock()
        servos.joints.advance(clock.now_ns())
        imu = gx5_imu(sensors.imu_line, round(robot.imu.rate))
        self._body, _ = servos.in_process(clock, imu=imu, power=PowerMonitor(sensors.power_line))
        self._body.prepare()
        # To make servos ready took its time on the bus: control begins with the simulator's next tick but one.
        clock.sleep_until((clock.now_ns() // TICK_NS + 2) * TICK_NS)
        servos.joints.advance(clock.now_ns() - TICK_NS)

    def wait_next(self) -> int:
        return self._body.wait_next()

    def read(self) -> Proprioception:
        return self._body.read()

    def write(self, targets: JointTargets) -> None:
        self._body.write(targets)

    def troubles(self) -> list[str]:
        """What is wrong with servos and buses, one sentence each."""
        return list(self._body.troubles())

    def truth(self) -> TruthState:
        return self._simulated.truth()

    def camera_due(self) -> bool:
        return self._simulated.camera_due()

    def scene_state(self) -> SceneState:
        return self._simulated.scene_state()

    def close(self) -> None:
        self._body.close()
        self._simulated.close()
