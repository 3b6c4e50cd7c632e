"""Odometry over a robot's recording is the odometry the robot would have had, to the last digit."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pybullet")

from made_up_recordings import write

from robot_agent.command_line.odometry import main
from robot_agent.evaluation.robot_recording import open_robot_recording
from robot_agent.evaluation.trajectory import read_tum
from robot_agent.felt_queue import Felt, FeltQueue
from robot_agent.odometry import OwnLegs, StereoInertialOdometry
from robot_agent.recording import Recorder, RecordingWriter
from robot_agent.vision.camera import StereoCalibration
from sim_agent.lock_step import LockStep
from sim_agent.worlds import make_world
from weaver_shared import topics
from weaver_shared.clock import SimulatedClock
from weaver_shared.errors import InputError
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.messages import CommandName, OdometryEstimate, StereoFrame
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

SECONDS = 1.0


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[OdometryEstimate], list[OdometryEstimate]]:
    """A robot that begins to stand up, recorded; and what odometry said meanwhile, without and with its feet."""
    path = tmp_path_factory.mktemp("lived") / "run.mcap"
    robot = load_robot()
    run = LockStep(robot, make_world("flat", 1), 1)
    writer = RecordingWriter(path, robot_id=run.robot_id, robot=robot, clock=run.clock, started="now")
    recorder = Recorder(run.bus, run.robot_id, writer)
    calibration = StereoCalibration.of_robot(robot)
    alone, on_feet = (
        StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=Pose.identity()) for _ in range(2)
    )
    said: list[OdometryEstimate] = []
    said_on_feet: list[OdometryEstimate] = []

    def look(frame: StereoFrame, felt: Felt) -> None:
        said.append(alone.step(frame, felt.imu))
        said_on_feet.append(on_feet.step(frame, felt.imu, FootContacts.of(robot, felt.legs)))

    run.on_picture = look
    try:
        run.step()
        for command in (CommandName.TAKE_CONTROL, CommandName.STAND):
            assert run.operator.send(command).accepted
        for _ in range(round(SECONDS * 100)):
            run.step()
            recorder.turn()
    finally:
        run.close()
    writer.close()
    return path, said, said_on_feet


@pytest.mark.parametrize("contacts", [False, True])
def test_the_recorded_way_is_the_lived_one(
    lived: tuple[Path, list[OdometryEstimate], list[OdometryEstimate]],
    contacts: bool,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path, *estimates = lived
    out = tmp_path / "trajectory.txt"
    flags = ["--contacts"] if contacts else []
    assert main([str(path), "--json", "--quiet", "--out", str(out), *flags]) == 0
    report = json.loads(capsys.readouterr().out)
    expected = estimates[contacts]
    assert report["frames"] == len(expected) >= 10
    assert report["contacts"] is contacts
    assert report["final_position"] == pytest.approx(expected[-1].position_in_world.tolist(), abs=1e-9)
    assert report["gyro_bias"] == pytest.approx(expected[-1].gyro_bias.tolist(), abs=1e-9)
    assert report["ate_m"] < 0.003
    assert report["gravity_error_deg"] < 0.5
    assert read_tum(out).position == pytest.approx(np.array([e.position_in_world for e in expected]), abs=1e-6)


def test_nothing_is_followed_on_the_robots_own_legs(
    lived: tuple[Path, list[OdometryEstimate], list[OdometryEstimate]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The same ride, but told with the legs raised before the eyes."""
    robot = load_robot()
    raised = np.zeros((robot.leg_count, robot.joint_count // robot.leg_count))
    raised[:, :3] = -0.6, 0.9, -1.2
    writer = RecordingWriter(
        tmp_path / "raised.mcap", robot_id="sim-1", robot=robot, clock=SimulatedClock(), started="now"
    )
    queue = FeltQueue()
    masked = StereoInertialOdometry(
        calibration=StereoCalibration.of_robot(robot), imu=robot.imu, initial=Pose.identity()
    )
    recording = open_robot_recording(lived[0])
    inertia = iter(recording)
    for _, _, message in recording.recording.messages(topics.STEREO, topics.PROPRIOCEPTION):
        if isinstance(message, StereoFrame):
            writer.write(topics.STEREO.key, message)
            frame, samples = next(inertia)
            expected = masked.step(frame, samples, None, OwnLegs.of(robot, queue.up_to(frame.stamp_ns).legs))
        else:
            sensed = replace(message, joint_position=raised.ravel())
            writer.write(topics.PROPRIOCEPTION.key, sensed)
            queue.add(sensed)
    writer.close()
    assert main([str(tmp_path / "raised.mcap"), "--json", "--quiet"]) == 0
    found = json.loads(capsys.readouterr().out)["position_sigma"]
    assert found == pytest.approx(np.sqrt(np.diag(expected.covariance)[3:]).tolist(), rel=1e-9)
    assert found != pytest.approx(np.sqrt(np.diag(lived[1][-1].covariance)[3:]).tolist(), rel=1e-3)


def test_legs_are_told_by_their_newest_reading(
    lived: tuple[Path, list[OdometryEstimate], list[OdometryEstimate]],
) -> None:
    recording = open_robot_recording(lived[0])
    stamp = int(recording.legs.stamp_ns[5])
    assert recording.legs_up_to(stamp).stamp_ns.tolist() == [stamp]
    assert recording.legs_up_to(stamp + 1).joint_position == pytest.approx(recording.legs.joint_position[5:6])
    assert not recording.legs_up_to(int(recording.legs.stamp_ns[0]) - 1).stamp_ns.size
    assert not recording.legs_up_to(int(recording.legs.stamp_ns[-1]) + 200_000_000).stamp_ns.size


def test_inertia_comes_with_the_picture_it_leads_to(
    lived: tuple[Path, list[OdometryEstimate], list[OdometryEstimate]],
) -> None:
    recording = open_robot_recording(lived[0])
    seen = -1
    for (frame, batch), stamp in zip(recording, recording.picture_ns, strict=True):
        assert frame.stamp_ns == stamp
        assert batch.stamp_ns[-1] >= stamp
        assert batch.stamp_ns[0] > seen
        seen = int(batch.stamp_ns[-1])


def test_a_cut_recording_is_followed_up_to_the_cut(
    lived: tuple[Path, list[OdometryEstimate], list[OdometryEstimate]],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    caplog: pytest.LogCaptureFixture,
) -> None:
    data = lived[0].read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) * 2 // 3])
    assert main([str(tmp_path / "cut.mcap"), "--json", "--quiet"]) == 0
    assert 4 <= json.loads(capsys.readouterr().out)["frames"] < len(lived[1])
    assert "was cut off" in caplog.text


def test_a_recording_without_pictures_is_refused(tmp_path: Path) -> None:
    write(tmp_path / "blind.mcap", seconds=0.2, pictures=False)
    with pytest.raises(InputError, match="has no pictures; it was recorded without them"):
        main([str(tmp_path / "blind.mcap"), "--json", "--quiet"])


def test_a_recording_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere\.mcap can not be read"):
        main([str(tmp_path / "nowhere.mcap"), "--json", "--quiet"])
