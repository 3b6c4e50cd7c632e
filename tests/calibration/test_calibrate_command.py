"""`weaver calibrate` on a rendered recording and on real chessboards, with good and bad input."""

from __future__ import annotations

import json
import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from own_recordings import SIZE

from robot_agent.calibration.kalibr_files import write_camchain
from robot_agent.calibration.pictures import open_pictures
from robot_agent.calibration.rig import Rig
from robot_agent.command_line import calibrate
from robot_agent.recording import RecordingWriter
from robot_agent.vision.camchain import read_chain
from sim_agent.command_line import study_calibration
from sim_agent.targets.recording import RigTruth
from weaver_shared.clock import SimulatedClock
from weaver_shared.command_line import main
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_exp

BOARDS = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "calibration" / "stereo_chessboard"


Run = Callable[..., tuple[int, dict[str, object], str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    """Exit code, JSON and standard error of `weaver calibrate ... --json --quiet`."""

    def call(*arguments: object) -> tuple[int, dict[str, object], str]:
        code = main(["calibrate", *map(str, arguments), "--quiet", "--json"])
        out, err = capsys.readouterr()
        return code, json.loads(out) if out else {}, err

    return call


def test_cameras_of_a_recording(recording: Path, truth: RigTruth, tmp_path: Path, run: Run) -> None:
    code, report, _ = run("cameras", recording, "--target", recording / "target.yaml", "--out", tmp_path)
    assert code == 0
    assert report["usable"], report["faults"]
    assert report["baseline_m"] == pytest.approx(truth.rig.baseline, abs=5e-4)
    found = Rig.of(read_chain(tmp_path / "camchain.yaml").cameras)
    assert np.abs(found.intrinsics[:, :2] / truth.rig.intrinsics[:, :2] - 1.0).max() < 0.01
    markdown = (tmp_path / "report.md").read_text()
    assert markdown.startswith("# Calibration of the cameras\n**Usable")
    assert (tmp_path / "report.html").read_text().count("<svg") == 5
    camera = tomllib.loads((tmp_path / "camera.toml").read_text())["camera"]
    assert (camera["width"], camera["height"]) == SIZE
    assert camera["baseline"] == pytest.approx(report["baseline_m"], abs=1e-6)


def test_camera_and_imu_of_a_recording(recording: Path, truth: RigTruth, tmp_path: Path, run: Run) -> None:
    files = (
        "--cameras",
        recording / "truth.yaml",
        "--imu",
        recording / "imu.yaml",
        "--target",
        recording / "target.yaml",
    )
    code, report, _ = run("imu", recording, *files, "--out", tmp_path, "--knots", 30)
    assert code == 0
    assert report["usable"], report["faults"]
    assert report["timeshift_cam_imu"] == pytest.approx(truth.time_offset, abs=1e-4)
    np.testing.assert_allclose(report["T_cam_imu"], truth.camera_from_imu.matrix, atol=2e-3)
    chain = read_chain(tmp_path / "camchain-imucam.yaml")
    assert chain.time_offset == report["timeshift_cam_imu"]
    assert "gyro residuals" in (tmp_path / "report.html").read_text()


def test_a_robots_own_recording_is_seen_as_the_folder_is(recording: Path, own_recording: Path, run: Run) -> None:
    folder, own = open_pictures(recording), open_pictures(own_recording)
    for (stamp, _, pictures), (own_stamp, _, own_pictures) in zip(folder, own, strict=True):
        assert stamp == own_stamp
        np.testing.assert_array_equal(np.array(pictures), np.array(own_pictures))
    assert folder.inertia is not None
    assert own.inertia is not None
    for name in ("stamp_ns", "angular_velocity_in_imu", "specific_force_in_imu"):
        np.testing.assert_array_equal(getattr(folder.inertia, name), getattr(own.inertia, name))
    target = ("--target", recording / "target.yaml", "--cameras", recording / "truth.yaml")
    code, report, _ = run("check", own_recording, *target)
    assert (code, report["holds"]) == (0, True)


def test_a_robots_own_recording_without_pictures_is_refused(tmp_path: Path, recording: Path, run: Run) -> None:
    path = tmp_path / "blind.mcap"
    RecordingWriter(path, robot_id="sim-1", robot=load_robot(), clock=SimulatedClock(), started="now").close()
    target = ("--target", recording / "target.yaml", "--out", tmp_path)
    assert "has no pictures; it was recorded without them" in refused(run("cameras", path, *target))
    assert "can not be read: No such file" in refused(run("cameras", tmp_path / "no.mcap", *target))


def test_a_true_file_holds_and_a_bent_one_does_not(recording: Path, truth: RigTruth, tmp_path: Path, run: Run) -> None:
    arguments = ("check", recording, "--target", recording / "target.yaml", "--cameras")
    code, report, _ = run(*arguments, recording / "truth.yaml")
    assert (code, report["holds"]) == (0, True)
    second = truth.rig.eye_from_first[1]
    bent = Pose(rotation=rotation_exp([0.008, 0.0, 0.0]) @ second.rotation, position=1.02 * second.position)
    rig = Rig(
        models=truth.rig.models,
        intrinsics=truth.rig.intrinsics,
        eye_from_first=(truth.rig.eye_from_first[0], bent),
        sizes=truth.rig.sizes,
    )
    write_camchain(rig, tmp_path / "bent.yaml")
    code, report, _ = run(*arguments, tmp_path / "bent.yaml")
    assert (code, report["holds"]) == (0, False)
    assert "an eye has moved" in str(report["faults"])
    assert report["turned_deg"] == pytest.approx(np.degrees(0.008), rel=0.15)
    assert report["size_ratio"] == pytest.approx(1.02, abs=0.01)


def test_real_chessboards_are_as_near_as_opencvs_own(capsys: pytest.CaptureFixture[str]) -> None:
    if not BOARDS.is_dir():
        pytest.skip(f"needs the shared data in {BOARDS}")
    assert study_calibration.main(["--runs", "0", "--boards", str(BOARDS), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    boards = report["boards"]
    assert boards["pairs"] == 13
    assert boards["reprojection_px"] == pytest.approx(boards["opencv_px"], rel=0.05)
    assert boards["baseline_m"] == pytest.approx(boards["opencv_baseline_m"], abs=1e-4)
    assert report["goals_met"]


def test_a_page_and_its_description_are_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert calibrate.main(["target", "--out", str(tmp_path / "target.pdf"), "--columns", "4", "--rows", "5"]) == 0
    assert (tmp_path / "target.pdf").read_bytes().startswith(b"%PDF-1.4")
    assert "tagCols: 4" in (tmp_path / "target.yaml").read_text()
    assert "100 %" in capsys.readouterr().out


def test_bad_input_is_answered_with_a_sentence(recording: Path, tmp_path: Path, run: Run) -> None:
    target = ("--target", recording / "target.yaml", "--out", tmp_path / "out")
    (tmp_path / "empty").mkdir()
    assert "is not a folder" in refused(run("cameras", tmp_path / "missing", *target))
    assert "has no pictures" in refused(run("cameras", tmp_path / "empty", *target))
    assert "can not be read as Kalibr's target" in refused(run("cameras", recording, "--target", tmp_path / "no.yaml"))
    blank = tmp_path / "blank"
    blank.mkdir()
    for k in range(3):
        cv2.imwrite(str(blank / f"left{k}.png"), np.full((120, 160), 90, dtype=np.uint8))
    assert "the right eye is missing" in refused(run("cameras", blank, *target))
    for k in range(3):
        cv2.imwrite(str(blank / f"right{k}.png"), np.full((120, 160), 90, dtype=np.uint8))
    assert "no target found in any of the 3 pictures" in refused(run("cameras", blank, *target))
    cv2.imwrite(str(blank / "left2.png"), np.full((100, 160), 90, dtype=np.uint8))
    assert "is 160 x 100 px, the pictures before it 160 x 120" in refused(run("cameras", blank, *target))
    (blank / "left2.png").write_text("no picture")
    assert "can not be read as a picture" in refused(run("cameras", blank, *target))


def test_what_an_imu_recording_lacks_is_named(recording: Path, truth: RigTruth, tmp_path: Path, run: Run) -> None:
    files = ("--imu", recording / "imu.yaml", "--target", recording / "target.yaml", "--out", tmp_path / "out")
    still = tmp_path / "still"
    shutil.copytree(recording / "mav0", still / "mav0", ignore=shutil.ignore_patterns("imu0"))
    assert "no inertial samples (imu0/data.csv)" in refused(
        run("imu", still, "--cameras", recording / "truth.yaml", *files)
    )
    one = Rig(
        models=truth.rig.models[:1],
        intrinsics=truth.rig.intrinsics[:1],
        eye_from_first=truth.rig.eye_from_first[:1],
        sizes=truth.rig.sizes[:1],
    )
    write_camchain(one, tmp_path / "one.yaml")
    assert "has 1 cameras" in refused(run("imu", recording, "--cameras", tmp_path / "one.yaml", *files))
    larger = Rig(
        models=truth.rig.models,
        intrinsics=truth.rig.intrinsics,
        eye_from_first=truth.rig.eye_from_first,
        sizes=((640, 480), (640, 480)),
    )
    write_camchain(larger, tmp_path / "larger.yaml")
    assert "640 x 480 px, the pictures 320 x 240" in refused(
        run("imu", recording, "--cameras", tmp_path / "larger.yaml", *files)
    )


def refused(answer: tuple[int, dict[str, object], str]) -> str:
    """The one sentence of a refusal."""
    code, report, sentence = answer
    assert (code, report) == (2, {})
    assert len(sentence.strip().splitlines()) == 1
    return sentence
