"""Robots for hardware tests: a simulated one on a stand, alone, behind emulated buses in process and on terminals."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing
from pathlib import Path

import pytest
from hardware_bodies import BRISK, PATIENT, STAND, Twin

from robot_agent.body import Body
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.imu.stream import gx5_imu
from robot_agent.hardware.opening import open_body
from robot_agent.hardware.power_monitor import PowerMonitor
from robot_agent.hardware.serial_line import ByteLine
from robot_agent.hardware.wiring import Wiring
from sim_agent.body import SimulatedBody
from sim_agent.model import sitting_joints
from sim_agent.sensor_lines import EmulatedGx5, TwinSensors
from sim_agent.servo_bus.body_joints import BodyJoints
from sim_agent.servo_bus.joints import FirstOrderJoints
from sim_agent.servo_bus.trace import ReplayedBus, ReplayedLine, TracedBus, TracedLine, load_trace, save_trace
from sim_agent.servo_bus.twin import KIND, TwinServos, TwinTerminals
from sim_agent.servo_bus.twin_wiring import twin_wiring
from sim_agent.servo_bus.virtual_port import VirtualPort
from sim_agent.servo_bus.wire import Answering, VirtualLineClock
from sim_agent.worlds import make_world
from weaver_shared.config.hardware import ServoSettings
from weaver_shared.robots import RobotDescription, load_robot


@pytest.fixture(scope="session")
def robot() -> RobotDescription:
    return load_robot("weaver")


@pytest.fixture
def make_twin(robot: RobotDescription, tmp_path: Path) -> Iterator[Callable[..., Twin]]:
    """Makes prepared hardware bodies in process; on a stand unless told otherwise."""
    with ExitStack() as stack:

        def make(settings: ServoSettings = BRISK, *, held_at: float | None = STAND) -> Twin:
            wiring = Wiring(twin_wiring(robot, tmp_path, settings=settings), robot)
            simulated = stack.enter_context(closing(SimulatedBody(robot, make_world("flat", 1), 1, held_at=held_at)))
            sensors = TwinSensors(EmulatedGx5())
            servos = TwinServos(wiring, lambda servos: BodyJoints(servos, simulated, wiring, heard=sensors.hear))
            clock = VirtualLineClock(1_000_000_000)
            imu, power = gx5_imu(sensors.imu_line, 200), PowerMonitor(sensors.power_line)
            body, ports = servos.in_process(clock, imu=imu, power=power)
            stack.enter_context(closing(body)).prepare()
            wanted = body.read().joint_position
            return Twin(body, servos, sensors, ports, clock, wiring, wanted)

        yield make


@pytest.fixture(params=["simulated", "in process", "terminal", "replayed"])
def body(
    request: pytest.FixtureRequest, robot: RobotDescription, tmp_path: Path, make_twin: Callable[..., Twin]
) -> Iterator[Body]:
    """One of the bodies that control may be given, on a stand."""
    if request.param == "in process":
        yield make_twin().body
        return
    if request.param == "simulated":
        with closing(SimulatedBody(robot, make_world("flat", 1), 1, held_at=STAND)) as simulated:
            yield simulated
        return
    if request.param == "replayed":
        # The test itself is what is recorded, and then hears the same bytes again.
        traces = _recorded(request.function, robot, tmp_path)
        with closing(_on_lines(robot, tmp_path, *traces)) as replayed:
            replayed.prepare()
            yield replayed
        return
    # Simple joints: a simulator could not keep real time on a busy computer.
    wiring = Wiring(twin_wiring(robot, tmp_path, settings=PATIENT), robot)
    shafts = wiring.shaft(sitting_joints(robot))
    servos = TwinServos(wiring, lambda servos: FirstOrderJoints(servos, start=shafts, most_steps=4))
    with TwinTerminals(servos, paced=False), closing(open_body(wiring, kind=KIND)) as real:
        real.prepare()
        yield real


def _recorded(
    test: Callable[[Body], None], robot: RobotDescription, folder: Path
) -> tuple[dict[str, ReplayedBus], ReplayedLine]:
    """What went over the lines of a body on a stand while a test had it, by way of a file."""
    wiring = Wiring(twin_wiring(robot, folder, settings=BRISK), robot)
    with closing(SimulatedBody(robot, make_world("flat", 1), 1, held_at=STAND)) as simulated:
        sensors = TwinSensors(EmulatedGx5())
        servos = TwinServos(wiring, lambda servos: BodyJoints(servos, simulated, wiring, heard=sensors.hear))
        buses = {name: TracedBus(bus) for name, bus in servos.buses.items()}
        line = TracedLine(sensors.imu_line)
        with closing(_on_lines(robot, folder, buses, line)) as body:
            body.prepare()
            test(body)
    replayed = {}
    for name, bus in buses.items():
        save_trace(folder / name, bus.trace)
        replayed[name] = ReplayedBus(load_trace(folder / name))
    return replayed, ReplayedLine(line.trace)


def _on_lines(
    robot: RobotDescription, folder: Path, buses: Mapping[str, Answering], imu_line: ByteLine
) -> HardwareBody:
    wiring = Wiring(twin_wiring(robot, folder, settings=BRISK), robot)
    clock = VirtualLineClock(1_000_000_000)
    ports = {name: VirtualPort(bus, clock, name) for name, bus in buses.items()}
    return HardwareBody(wiring, ports, clock, kind=KIND, imu=gx5_imu(imu_line, 200))
