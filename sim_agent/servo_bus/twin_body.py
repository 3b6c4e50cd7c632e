"""A simulated robot that is only reached through its devices' bytes: the hardware code as it is, in lock step.

Every byte goes through a pseudo-terminal of its device, opened and locked by the driver. The bus's clock and the
simulator's tell the same time: both begin at 0, and a tick of the one is a tick of the other.
"""

from __future__ import annotations

import sys
import tempfile
from contextlib import ExitStack, closing
from pathlib import Path

from robot_agent.body import JointTargets, Trouble
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.imu.stream import gx5_imu
from robot_agent.hardware.power_monitor import BAUD, PowerMonitor
from robot_agent.hardware.wiring import Wiring
from sim_agent.body import TICK_NS, SimulatedBody
from sim_agent.sensor_lines import EmulatedGx5, TwinSensors
from sim_agent.servo_bus.body_joints import BodyJoints
from sim_agent.servo_bus.stepped_port import SteppedLine, SteppedPort
from sim_agent.servo_bus.stepped_terminal import SteppedTerminal
from sim_agent.servo_bus.twin import KIND, TwinServos
from sim_agent.servo_bus.twin_wiring import twin_wiring
from sim_agent.servo_bus.wire import VirtualLineClock
from sim_agent.worlds import World
from weaver_shared.messages import Proprioception, SceneState, TruthState
from weaver_shared.robots import RobotDescription

SWITCH_INTERVAL = 2e-4
"""s. Each system call lets another thread have the interpreter, which by default keeps it for 5 ms: with vision at
work beside, a tick's twenty calls would take ten times as long as the tick."""


class TwinBody:
    """A `robot_agent.body.Body` on emulated servos, IMU and power monitor; truth and scene are the simulator's."""

    kind = KIND

    def __init__(self, robot: RobotDescription, world: World, seed: int) -> None:
        self.robot = robot
        self._simulated = SimulatedBody(robot, world, seed)
        self._terminals = ExitStack()
        self._terminals.callback(sys.setswitchinterval, sys.getswitchinterval())
        sys.setswitchinterval(SWITCH_INTERVAL)
        folder = Path(self._terminals.enter_context(tempfile.TemporaryDirectory(prefix="weaver-twin-")))
        wiring = Wiring(twin_wiring(robot, folder), robot)

        def go_on(now_ns: int) -> None:
            servos.joints.advance(now_ns)

        sensors = TwinSensors(
            EmulatedGx5(), lambda name, device: SteppedLine(device, self._terminal(folder / name), BAUD, go_on)
        )
        servos = TwinServos(
            wiring, lambda servos: BodyJoints(servos, self._simulated, wiring, heard=sensors.hear), seed=seed
        )
        clock = VirtualLineClock()
        servos.joints.advance(clock.now_ns())
        self._body = HardwareBody(
            wiring,
            {
                bus.name: SteppedPort(servos.buses[bus.name], self._terminal(Path(bus.port)), bus.baud, clock)
                for bus in wiring.config.buses
            },
            clock,
            kind=KIND,
            imu=gx5_imu(sensors.imu_line, round(robot.imu.rate)),
            power=PowerMonitor(sensors.power_line),
        )
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

    def findings(self) -> list[Trouble]:
        return self._body.findings()

    def joint_faults(self) -> tuple[str, ...]:
        return self._body.joint_faults()

    @property
    def holding(self) -> bool:
        return self._body.holding

    def truth(self) -> TruthState:
        return self._simulated.truth()

    def camera_due(self) -> bool:
        return self._simulated.camera_due()

    def scene_state(self) -> SceneState:
        return self._simulated.scene_state()

    def close(self) -> None:
        self._body.close()
        self._terminals.close()
        self._simulated.close()

    def _terminal(self, link: Path) -> SteppedTerminal:
        return self._terminals.enter_context(closing(SteppedTerminal(link)))
