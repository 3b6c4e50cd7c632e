"""Camera and IMU guided: what was felt of each motion is told, what lacks is said, and the result is Kalibr's files."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from calibrator_desk import Desk
from own_recordings import small_eyed
from target_scenes import GRID, IMU, Scene

from robot_agent.calibration.felt_motion import FeltMotion
from robot_agent.calibration.guided_inertial import MOST_SECONDS, GuidedInertial
from robot_agent.calibration.kalibr_files import read_imu, read_target
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.session_orders import SessionOrder
from robot_agent.calibration.session_sources import LiveSource
from robot_agent.recording import RecordingWriter, open_recording
from robot_agent.vision.camchain import read_chain
from robot_agent.vision.camera import StereoCalibration
from sim_agent.targets.recording import RigTruth
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.errors import InputError
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import CommandName, ImuBatch, StereoFrame
from weaver_shared.transforms import rotation_exp, rotation_log

TARGET = "imu aprilgrid 4 4 0.08 0.3"
START, SOLVE, END = CommandName.START_CALIBRATION, CommandName.SOLVE_CALIBRATION, CommandName.END_CALIBRATION


def shaken(seconds: float, *, turn: float = 0.0, push: float = 0.0, axis: int = 0) -> ImuBatch:
    """Samples at 200 Hz of an IMU that swings 1.5 times a second, with amplitudes in rad/s and m/s^2."""
    times = np.arange(0.0, seconds, 0.005)
    omega = 2.0 * np.pi * 1.5
    along = np.eye(3)[axis]
    angles = turn / omega * np.sin(omega * times)
    up = np.array([rotation_exp(-angle * along) @ [0.0, 0.0, GRAVITY] for angle in angles])
    return ImuBatch(
        stamp_ns=np.rint(times * 1e9).astype(np.int64) + 1,
        angular_velocity_in_imu=np.outer(turn * np.cos(omega * times), along),
        specific_force_in_imu=up + np.outer(push * np.cos(omega * times), along),
    )


def pair(stamp_ns: int, picture: np.ndarray) -> StereoFrame:
    return StereoFrame(stamp_ns=stamp_ns, sequence=1, left=picture, right=picture)


@pytest.fixture
def guided() -> GuidedInertial:
    eyes = StereoCalibration.of_robot(small_eyed())
    return GuidedInertial(GRID, Rig.of((eyes.left, eyes.right)), "the robot's description", IMU)


@pytest.mark.parametrize("axis", range(3))
def test_a_turn_is_felt_about_its_axis_and_is_no_push(axis: int) -> None:
    motion = FeltMotion()
    motion.feel(shaken(6.0, turn=1.0, axis=axis), counts=True)
    expected = np.zeros(6)
    expected[axis] = np.sqrt(0.5)
    assert motion.now == pytest.approx(expected, abs=0.03)
    assert motion.seconds[axis] == pytest.approx(6.0, abs=1.1)
    assert np.delete(motion.seconds, axis).max() == 0.0


@pytest.mark.parametrize("axis", range(3))
def test_a_push_is_felt_along_its_axis_beyond_gravity(axis: int) -> None:
    motion = FeltMotion()
    motion.feel(shaken(6.0, push=2.0, axis=axis), counts=True)
    assert motion.now[3 + axis] == pytest.approx(np.sqrt(2.0), rel=0.05)
    assert motion.seconds[3 + axis] > 4.0
    assert np.delete(motion.seconds, 3 + axis).max() == 0.0


def test_what_is_felt_while_no_target_is_seen_does_not_count() -> None:
    motion = FeltMotion()
    motion.feel(shaken(3.0, turn=1.0), counts=False)
    assert motion.now[0] > 0.5
    assert motion.seconds.max() == 0.0


def test_what_lacks_is_said_in_its_order(guided: GuidedInertial, own_recording: Path) -> None:
    frame = next(open_recording(own_recording).messages(topics.STEREO))[2]
    grey = np.full((240, 320), 90, dtype=np.uint8)
    guided.look(pair(1, grey))
    assert guided.advice().startswith("no samples of the IMU come")
    guided.feel(shaken(0.5))
    assert guided.advice().startswith("bring the target into the picture and keep it there: looking for an AprilGrid")
    assert guided.look(pair(600_000_000, frame.left))
    assert guided.advice() == "roll it, left side up, right side up, quickly, with 0.15 rad/s or more, for 10 s more"
    assert [motion.met for motion in guided.motions()] == [False] * 6


def test_pictures_that_come_too_seldom_are_told_of(guided: GuidedInertial, own_recording: Path) -> None:
    frame = next(open_recording(own_recording).messages(topics.STEREO))[2]
    for k in range(12):
        guided.feel(shaken(0.01))
        guided.look(pair((1 + k) * 500_000_000, frame.left))
    assert guided.seconds == 0.0
    assert guided.wishes()[1].what == "2.0 pictures a second"
    assert guided.advice().startswith("pictures are looked at too seldom: record the motion first")


def test_no_more_is_kept_than_can_be_solved(guided: GuidedInertial, own_recording: Path) -> None:
    frame = next(open_recording(own_recording).messages(topics.STEREO))[2]
    guided.feel(shaken(0.5))
    guided.look(pair(0, frame.left))
    guided.seconds = MOST_SECONDS
    views, samples = guided.views, guided.samples
    assert not guided.look(pair(10**9, frame.left))
    guided.feel(shaken(0.5))
    assert (guided.views, guided.samples) == (views, samples)
    assert guided.advice() == "no more is kept: solve, or start again"


def test_too_little_is_refused_by_what_it_lacks(guided: GuidedInertial, own_recording: Path) -> None:
    with pytest.raises(InputError, match="there are no samples of the IMU"):
        guided.solve()
    guided.feel(shaken(0.5))
    with pytest.raises(InputError, match="the target was seen in none of 0 pictures: looked for an AprilGrid"):
        guided.solve()
    guided.look(next(open_recording(own_recording).messages(topics.STEREO))[2])
    with pytest.raises(InputError, match=r"in view for 0\.0 s; at least 5 s are needed"):
        guided.solve()


def test_rest_and_turns_about_one_axis_are_refused(guided: GuidedInertial, scene: Scene) -> None:
    still = GuidedInertial(GRID, scene.truth.rig, "the truth", IMU)
    still._views, still.seconds = list(scene.views), 9.0
    calm = ImuBatch(
        stamp_ns=scene.inertia.stamp_ns,
        angular_velocity_in_imu=0.01 * scene.inertia.angular_velocity_in_imu,
        specific_force_in_imu=scene.inertia.specific_force_in_imu,
    )
    still.feel(calm)
    with pytest.raises(InputError, match="hardly any turning about the IMU's x and y and z axis"):
        still.solve()


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("imu a plate", "is no target"),
        ("imu aprilgrid 4 4 0.08 0.3 with ../else", "is not the name of a calibration"),
        ("imu aprilgrid 4 4 0.08 0.3 with a from ../b", "is not the name of a recording"),
    ],
)
def test_an_order_that_is_none_is_refused(text: str, complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        SessionOrder.of(text)


def test_live_samples_come_with_the_picture_after_them(own_recording: Path) -> None:
    bus = MemoryBus()
    source = LiveSource(bus, "sim-1", inertia=True)
    felt: list[ImuBatch] = []
    for _, _, message in open_recording(own_recording).messages(topics.STEREO, topics.PROPRIOCEPTION):
        topic = topics.STEREO if isinstance(message, StereoFrame) else topics.PROPRIOCEPTION
        bus.publish("sim-1", topic, message)
        if isinstance(message, StereoFrame):
            break
    frame = source.take(felt.append, 0.0)
    assert frame is not None
    assert frame.stamp_ns == message.stamp_ns
    assert 2 < len(ImuBatch.join(felt).stamp_ns) < 200
    assert ImuBatch.join(felt).stamp_ns[-1] <= frame.stamp_ns
    assert source.take(felt.append, 0.0) is None


def test_a_recording_leads_to_where_the_imu_is(desk: Desk, recording: Path, truth: RigTruth, tmp_path: Path) -> None:
    (tmp_path / "known").mkdir()
    shutil.copy(recording / "truth.yaml", tmp_path / "known" / "camchain.yaml")
    assert desk.order(START, f"{TARGET} with known from own.mcap").accepted
    starting = next(told for told in desk.told if told.phase == "starting")
    assert (starting.part, starting.lenses) == ("imu", "known")
    desk.await_end_of_recording()
    looking = desk.told[-1]
    assert (looking.phase, looking.source) == ("looking", "own.mcap")
    assert looking.seconds > 5.0
    assert [f"{motion.kind} {motion.axis}" for motion in looking.motions[:3]] == ["turn x", "turn y", "turn z"]
    assert min(motion.seconds for motion in looking.motions[:3]) > 1.0
    assert desk.order(SOLVE).accepted
    solved = desk.await_solution()
    assert solved.phase == "solved", solved.verdict
    steps = [state.step for state in desk.told if state.phase == "solving" and state.step]
    assert len(steps) > 1
    assert len(steps) == len(set(steps)), "a step is told once"
    folder = tmp_path / solved.files[0].partition("/")[0]
    assert {path.name for path in folder.iterdir()} == {
        "camchain-imucam.yaml", "imu.yaml", "target.yaml", "report.html", "report.md"
    }  # fmt: skip
    chain = read_chain(folder / "camchain-imucam.yaml")
    assert chain.camera_from_imu is not None
    apart = chain.camera_from_imu.rotation.T @ truth.camera_from_imu.rotation
    assert np.degrees(np.linalg.norm(rotation_log(apart))) < 0.2
    assert chain.camera_from_imu.position == pytest.approx(truth.camera_from_imu.position, abs=5e-3)
    assert chain.time_offset == pytest.approx(truth.time_offset, abs=5e-4)
    assert read_imu(folder / "imu.yaml").rate == small_eyed().imu.rate
    assert read_target(folder / "target.yaml") == GRID
    assert (folder / "report.html").read_text().count("<svg") == 3
    assert [line.partition(":")[0] for line in solved.results[:3]] == [
        "left camera in the IMU's frame",
        "its rotation vector",
        "from the robot's description",
    ]
    assert sum("±" in line for line in solved.results) == 5


def test_a_recording_without_an_imu_is_named(desk: Desk, own_recording: Path, tmp_path: Path) -> None:
    blind = own_recording.parent / "unfelt.mcap"
    writer = RecordingWriter(blind, robot_id="sim-1", robot=small_eyed(), clock=SimulatedClock(), started="now")
    for k, (_, key, message) in enumerate(open_recording(own_recording).messages(topics.STEREO)):
        if k < 3:
            writer.write(key, message)
    writer.close()
    assert "no calibration of cameras named nowhere" in desk.order(START, f"{TARGET} with nowhere").reason
    assert desk.order(START, f"{TARGET} from unfelt.mcap").accepted
    desk.await_end_of_recording()
    assert "no samples of the IMU come" in desk.told[-1].advice
    assert desk.order(SOLVE).accepted
    assert desk.await_solution().verdict.startswith("there are no samples of the IMU")
    assert desk.told[-1].phase == "failed"
    assert desk.order(END).accepted
    assert (desk.told[-1].phase, desk.told[-1].part) == ("idle", "cameras")
