"""Every fault that a robot has to stand up to: how soon it is seen, what is done, and that no servo lets go.

The whole walk loop stands on emulated servos, on the bus's own clock; a tick is 10 ms. Each row ends its fault and
finds the robot standing again, so that one robot serves them all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from hardware_bodies import KinematicBody

from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.imu.stream import gx5_imu
from robot_agent.hardware.power_monitor import PowerMonitor
from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.wiring import Wiring
from robot_agent.loops import WalkLoop
from robot_agent.pipeline import WalkTick
from sim_agent.sensor_lines import EmulatedGx5, TwinSensors
from sim_agent.servo_bus.body_joints import BodyJoints
from sim_agent.servo_bus.twin import TwinServos
from sim_agent.servo_bus.twin_wiring import twin_wiring
from sim_agent.servo_bus.virtual_port import VirtualPort
from sim_agent.servo_bus.wire import VirtualLineClock
from sim_agent.twin.faults import FAULTS, Devices, inject
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.config.hardware import ServoSettings
from weaver_shared.messages import CommandName, Event
from weaver_shared.operator import Operator
from weaver_shared.robots import load_robot

ROBOT_ID = "emulated-1"
WEAVER = load_robot("weaver")
MOST = 800
"""Ticks that the longest reaction may take."""


@dataclass
class Stand:
    """A robot that stands on emulated servos, with an operator who keeps control."""

    body: HardwareBody
    loop: WalkLoop
    clock: VirtualLineClock
    devices: Devices
    ports: dict[str, VirtualPort]
    operator: Operator
    events: list[str] = field(default_factory=list)
    last: WalkTick | None = None
    ticks: int = 0

    def tick(self, count: int = 1) -> WalkTick:
        for _ in range(count):
            if self.ticks % 40 == 0:
                self.operator.send(CommandName.RETAIN_CONTROL)
            self.last, _ = self.loop.tick()
            self.ticks += 1
        assert self.last is not None
        return self.last

    def until(self, condition: Callable[[WalkTick], object], most: int = MOST) -> int:
        """Ticks until it holds; fails after `most`."""
        for count in range(1, most + 1):
            if condition(self.tick()):
                return count
        raise AssertionError(f"not in {most} ticks: {self.last and (self.last.permission, self.last.verdict)}")

    def standing(self, tick: WalkTick) -> bool:
        return tick.permission.mode == "STAND" and tick.walk.posture == "standing"

    def torque(self) -> np.ndarray:
        return np.array([servo.table[r.TORQUE_ENABLE] == 1 for servo in self.devices.servos])

    def ordered(self, name: CommandName) -> None:
        answer = self.operator.send(name)
        assert answer.accepted, answer.reason


@pytest.fixture(scope="module")
def stand(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stand]:
    wiring = Wiring(twin_wiring(WEAVER, Path("/nowhere"), settings=ServoSettings(start_time=0.3)), WEAVER)
    sensors = TwinSensors(EmulatedGx5())
    servos = TwinServos(wiring, lambda servos: BodyJoints(servos, KinematicBody(WEAVER), wiring, heard=sensors.hear))
    clock = VirtualLineClock(1_000_000_000)
    body, ports = servos.in_process(clock, imu=gx5_imu(sensors.imu_line, 200), power=PowerMonitor(sensors.power_line))
    bus = MemoryBus()
    with closing(body):
        body.prepare()
        loop = WalkLoop(robot_id=ROBOT_ID, body=body, bus=bus, wall_clock_ns=clock.now_ns)

        def plug(name: str, there: bool) -> None:
            ports[name].plugged = there

        devices = Devices(
            joints=WEAVER.joint_names,
            servos=servos.servos,
            buses=servos.buses,
            sensors=sensors,
            now_ns=clock.now_ns,
            plug=plug,
        )
        made = Stand(body, loop, clock, devices, ports, Operator(bus, ROBOT_ID, "tester"))
        bus.subscribe(ROBOT_ID, topics.EVENT, lambda _id, _key, event: _hear(made, event))
        made.tick(20)
        made.ordered(CommandName.TAKE_CONTROL)
        made.ordered(CommandName.STAND)
        made.until(made.standing)
        yield made


def _hear(stand: Stand, event: Event) -> None:
    stand.events.append(event.text)


def seen(words: str, mode: str) -> Callable[[WalkTick], bool]:
    """The reaction: this mode, for a reason that says so."""
    return lambda tick: tick.permission.mode == mode and any(words in reason for reason in tick.verdict.reasons)


@dataclass(frozen=True)
class Row:
    fault: str
    target: str
    words: str  # of the reason
    mode: str
    within: int  # ticks
    value: float | None = None


HOLDS = [
    Row("lost-questions", "left", "does not answer", "HOLD", 6, 1.0),
    Row("dead", "BR_roll", "servo BR_roll does not answer", "HOLD", 5),
    Row("unplugged", "right", "bus right is down", "HOLD", 1),
    Row("encoder", "CL_femur", "CL_femur tells an angle", "HOLD", 6),
    Row("imu-silent", "", "the IMU has been silent", "HOLD", 22),
    Row("imu-frozen", "", "the IMU has been silent", "HOLD", 28),
]
"""Faults that end: the robot holds, and goes on when they are over."""


@pytest.mark.parametrize("row", HOLDS, ids=lambda row: row.fault)
def test_it_holds_until_the_fault_is_over(stand: Stand, row: Row) -> None:
    inject(stand.devices, row.fault, row.target, row.value)
    assert stand.until(seen(row.words, row.mode), row.within) <= row.within
    stand.tick(20)
    assert stand.torque().all()
    inject(stand.devices, row.fault, row.target, ending=True)
    stand.until(stand.standing)
    assert stand.body.troubles() == []


def test_a_silent_imu_freezes_the_inclination_before_the_robot_holds(stand: Stand) -> None:
    inject(stand.devices, "imu-silent")
    assert stand.until(lambda tick: "the direction of gravity is missing" in tick.walk.reasons, 8) >= 5
    assert stand.standing(stand.tick())
    inject(stand.devices, "imu-silent", ending=True)
    stand.until(lambda tick: stand.standing(tick) and not tick.walk.reasons)


SAID = [
    Row("power-silent", "", "the power monitor has been silent", "STAND", 130),
    Row("battery", "", "the battery is at 24", "STAND", 350, 23.5),
    Row("slow-adapter", "left", "set the adapters' latency timer", "STAND", 60),
    Row("hot", "AL_tibia", "at 62 degrees", "STAND", 2, 62.0),
]
"""Faults that are told, and nothing more at first."""


@pytest.mark.parametrize("row", SAID, ids=lambda row: row.fault)
def test_it_says_what_is_not_as_it_should_be(stand: Stand, row: Row) -> None:
    inject(stand.devices, row.fault, row.target, row.value)
    stand.until(lambda tick: any(row.words in text for text in tick.verdict.warnings), row.within)
    assert stand.torque().all()
    inject(stand.devices, row.fault, row.target, ending=True)
    stand.until(lambda tick: stand.standing(tick) and not tick.verdict.warnings)


BORNE = [
    Row("lost-answers", "left", "", "", 0, 0.02),
    Row("spoilt-answers", "AR_yaw", "", "", 0, 0.05),
    Row("lost-questions", "right", "", "", 0, 0.02),
    Row("imu-clock", "", "", "", 0, 100.0),
]
"""Faults that cost a reading now and then."""


@pytest.mark.parametrize("row", BORNE, ids=lambda row: row.fault)
def test_it_stands_on(stand: Stand, row: Row) -> None:
    inject(stand.devices, row.fault, row.target, row.value)
    for _ in range(100):
        tick = stand.tick()
        assert stand.standing(tick), tick.verdict
    inject(stand.devices, row.fault, row.target, ending=True)
    stand.tick(20)
    assert stand.torque().all()


SITS = [
    Row("power-silent", "", "the power monitor has been silent", "SIT", 530),
    Row("battery", "", "the battery is at 23", "SIT", 800, 21.8),
    Row("hot", "AL_tibia", "at 76 degrees", "SIT", 2, 76.0),
]
"""Faults with which it may stand no longer."""


@pytest.mark.parametrize("row", SITS, ids=lambda row: row.fault)
def test_it_sits_down_and_stands_again_when_told_to(stand: Stand, row: Row) -> None:
    inject(stand.devices, row.fault, row.target, row.value)
    stand.until(seen(row.words, row.mode), row.within)
    stand.until(lambda tick: tick.walk.posture == "sitting")
    assert stand.torque().all()
    inject(stand.devices, row.fault, row.target, ending=True)
    stand.until(lambda tick: not tick.verdict.reasons)
    stand.ordered(CommandName.STAND)
    stand.until(stand.standing)


MENDED = [
    Row("overload", "BL_femur", "servo BL_femur has shut down: overload", "HOLD", 1),
    Row("reset", "CR_tarsus", "servo CR_tarsus does not answer", "HOLD", 6),
]
"""Faults that an operator clears: sit and let go, by the stop; then the servo is made ready again."""


@pytest.mark.parametrize("row", MENDED, ids=lambda row: row.fault)
def test_it_holds_until_an_operator_clears_it(stand: Stand, row: Row) -> None:
    inject(stand.devices, row.fault, row.target)
    stand.until(seen(row.words, row.mode), row.within)
    stand.tick(30)
    others = np.array([name != row.target for name in stand.devices.joints])
    assert stand.torque()[others].all()
    assert not stand.torque()[~others].any()  # nothing reboots it under load
    stand.ordered(CommandName.STOP)
    stand.until(lambda tick: not tick.permission.torque_on)
    stand.until(lambda tick: not stand.body.troubles())
    stand.ordered(CommandName.RELEASE_STOP)
    stand.until(lambda tick: not tick.verdict.reasons)
    stand.ordered(CommandName.STAND)
    stand.until(stand.standing)


def test_when_all_lose_power_it_is_stopped_until_released(stand: Stand) -> None:
    inject(stand.devices, "brown-out")
    assert stand.until(lambda tick: tick.permission.mode == "HOLD") <= 6
    assert stand.until(lambda tick: tick.permission.mode == "ESTOP") <= 60
    assert "the servos' supply has failed: none knows its settings" in stand.events
    stand.until(lambda tick: not stand.body.troubles())
    stand.tick(50)
    assert not stand.torque().any()
    assert not stand.operator.send(CommandName.STAND).accepted
    stand.ordered(CommandName.RELEASE_STOP)
    stand.until(lambda tick: not tick.verdict.reasons)
    stand.ordered(CommandName.STAND)
    stand.until(stand.standing)


def test_a_jammed_joint_is_eased_and_the_robot_holds(stand: Stand) -> None:
    joint = "CR_femur"
    servo = stand.devices.servos[list(stand.devices.joints).index(joint)]
    stand.ordered(CommandName.SIT)
    stand.until(lambda tick: tick.permission.mode == "READY")
    inject(stand.devices, "jammed", joint)
    stand.ordered(CommandName.STAND)
    pulling, cap = 0, 0.0  # ticks in a row; the most it was allowed, of which the servo may still keep less before

    def stuck(tick: WalkTick) -> bool:
        nonlocal pulling, cap
        cap = max(cap, servo.table[r.GOAL_CURRENT])
        behind = abs(servo.table[r.GOAL_POSITION] - servo.table[r.PRESENT_POSITION]) * r.RAD_PER_COUNT
        hard = abs(servo.table[r.PRESENT_CURRENT]) >= 0.8 * servo.table[r.GOAL_CURRENT]
        pulling = pulling + 1 if behind > 0.26 and hard else 0
        return seen(f"joint {joint} is stuck", "HOLD")(tick)

    stand.until(stuck)
    assert 29 <= pulling <= 33  # 0.3 s, and a tick or two to hear of it
    stand.tick(2)
    assert servo.table[r.GOAL_CURRENT] == pytest.approx(0.3 * cap, rel=0.02)
    assert stand.torque().all()
    inject(stand.devices, "jammed", joint, ending=True)
    stand.until(stand.standing)


def test_after_a_stall_servos_hold_and_it_goes_on_softly(stand: Stand) -> None:
    stand.clock.forward(seconds=0.25)
    stand.tick()
    assert "servo AR_yaw has stopped: nothing was heard from the computer" in stand.body.troubles()
    assert stand.torque().all()
    stand.until(stand.standing)


def test_every_fault_has_its_row() -> None:
    rows = {row.fault for rows in (HOLDS, SAID, BORNE, SITS, MENDED) for row in rows}
    assert rows | {"brown-out", "jammed"} == set(FAULTS)
