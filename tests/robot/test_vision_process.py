"""The vision process begins where the robot stands, waits for inertia, and begins anew with a restarted robot."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from robot_agent import vision_process
from robot_agent.perception import CloseLook
from robot_agent.pipeline import VisionTick
from robot_agent.vision_process import VisionProcess
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.messages import (
    Command,
    CommandName,
    ImuBatch,
    OdometryEstimate,
    Proprioception,
    RobotState,
    StereoFrame,
)
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

MS = 1_000_000


class RecordingLoop:
    """Stands in for the stages: notes what it is given."""

    made: "list[RecordingLoop]" = []  # noqa: RUF012

    def __init__(self, **_: object) -> None:
        self.begun_at: Pose | None = None
        self.frames: list[int] = []
        self.felt: list[int] = []
        RecordingLoop.made.append(self)

    @property
    def begun(self) -> bool:
        return self.begun_at is not None

    def begin(self, pose: Pose) -> None:
        self.begun_at = pose

    def feel(self, sensed: Proprioception) -> None:
        self.felt.append(sensed.stamp_ns)

    def imu_covers(self, stamp_ns: int) -> bool:
        return bool(self.felt) and self.felt[-1] >= stamp_ns

    def step(self, frame: StereoFrame, *, closely: bool) -> VisionTick:
        self.frames.append(frame.stamp_ns)
        look = CloseLook(stamp_ns=frame.stamp_ns, cells=7, sigma=0.001, reason="") if closely else None
        odometry = OdometryEstimate.at_rest(Pose.of([0.0, 0.0, 0.1]), frame.stamp_ns)
        return VisionTick(odometry=odometry, terrain=None, report=None, tiles=(), look=look)


@pytest.fixture
def bus(monkeypatch: pytest.MonkeyPatch) -> MemoryBus:
    RecordingLoop.made.clear()
    monkeypatch.setattr(vision_process, "VisionLoop", RecordingLoop)
    monkeypatch.setattr(vision_process, "IMU_WAIT", 0.0)
    return MemoryBus()


@pytest.fixture
def process(bus: MemoryBus) -> VisionProcess:
    return VisionProcess(robot_id="sim-1", robot=load_robot(), bus=bus)


def see(bus: MemoryBus, process: VisionProcess, stamp_ns: int) -> None:
    picture = np.zeros((2, 2), dtype=np.uint8)
    bus.publish("sim-1", topics.STEREO, StereoFrame(stamp_ns=stamp_ns, sequence=0, left=picture, right=picture))
    process.turn()


def feel(bus: MemoryBus, stamp_ns: int, x: float = 0.0) -> None:
    sensed = Proprioception(
        stamp_ns=stamp_ns,
        joint_position=np.zeros(30),
        joint_velocity=np.zeros(30),
        joint_torque=np.zeros(30),
        joint_valid=np.ones(30, dtype=np.bool_),
        joint_temperature=np.zeros(30),
        foot_contact=np.ones(6, dtype=np.bool_),
        imu=ImuBatch.empty(),
        battery_voltage=26.0,
        supply_current=1.0,
        motor_power=1.0,
    )
    state = RobotState(
        stamp_ns=stamp_ns,
        position_in_world=np.array([x, 0.0, 0.1]),
        wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
        velocity_command=np.zeros(3),
        velocity_in_body=np.zeros(3),
        joint_position=np.zeros(30),
        joint_torque=np.zeros(30),
        foot_in_body=np.zeros((6, 3)),
        foot_contact=np.ones(6, dtype=np.bool_),
        foot_force=np.zeros(6),
        stability_margin=0.1,
        roll=0.0,
        pitch=0.0,
    )
    bus.publish("sim-1", topics.PROPRIOCEPTION, sensed)
    bus.publish("sim-1", topics.STATE, state)


def test_it_begins_where_the_walk_loop_says_the_robot_is(bus: MemoryBus, process: VisionProcess) -> None:
    see(bus, process, 50 * MS)
    assert not RecordingLoop.made[-1].begun
    feel(bus, 100 * MS, x=3.0)
    see(bus, process, 100 * MS)
    loop = RecordingLoop.made[-1]
    assert loop.begun_at is not None
    assert loop.begun_at.position[0] == 3.0
    assert loop.frames == [100 * MS]


def test_a_picture_ahead_of_the_inertia_is_left_out_and_no_inertia_lost(bus: MemoryBus, process: VisionProcess) -> None:
    feel(bus, 90 * MS)
    see(bus, process, 100 * MS)
    feel(bus, 110 * MS)
    feel(bus, 150 * MS)
    see(bus, process, 150 * MS)
    loop = RecordingLoop.made[-1]
    assert loop.frames == [150 * MS]
    assert loop.felt == [90 * MS, 110 * MS, 150 * MS]


def test_an_old_or_repeated_picture_is_left_out(bus: MemoryBus, process: VisionProcess) -> None:
    feel(bus, 200 * MS)
    for stamp in (200, 200, 150):
        see(bus, process, stamp * MS)
    assert RecordingLoop.made[-1].frames == [200 * MS]


def test_a_restarted_robot_is_a_new_beginning(bus: MemoryBus, process: VisionProcess) -> None:
    feel(bus, 5000 * MS, x=4.0)
    see(bus, process, 5000 * MS)
    feel(bus, 100 * MS, x=0.0)
    see(bus, process, 100 * MS)
    loop = RecordingLoop.made[-1]
    assert len(RecordingLoop.made) == 2
    assert loop.begun_at is not None
    assert loop.begun_at.position[0] == 0.0
    assert loop.frames == [100 * MS]


def test_a_close_look_is_taken_of_the_next_picture_and_answered(bus: MemoryBus, process: VisionProcess) -> None:
    command = Command(command=CommandName.LOOK_CLOSELY, operator="anna", lease_epoch=0, sequence=1)
    with ThreadPoolExecutor(1) as worker:
        answer = worker.submit(bus.ask, "sim-1", topics.VISION_COMMANDS, command)
        stamp_ns = 100 * MS
        while not answer.done():  # asked on another thread, at some picture
            feel(bus, stamp_ns)
            see(bus, process, stamp_ns)
            stamp_ns += 100 * MS
        assert answer.result().accepted
        assert answer.result().applied_value == 7.0
