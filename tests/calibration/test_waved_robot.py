"""A made-up recording of a robot that was waved before a target is one to calibrate with."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from own_recordings import small_eyed

from robot_agent.calibration.grid_detector import GridDetector
from robot_agent.calibration.pictures import open_pictures
from robot_agent.vision.camera import StereoCalibration
from robot_agent.vision.distortion import project
from sim_agent.command_line import study_calibration
from sim_agent.targets.waved_robot import GRID, built_askew, record_waved
from weaver_shared.errors import InputError
from weaver_shared.transforms import rotation_log


def test_the_recording_shows_the_target_and_has_the_imus_samples(tmp_path: Path) -> None:
    robot = small_eyed()
    heard: list[int] = []
    record_waved(tmp_path / "waved.mcap", robot, 1, 1.0, heard.append)
    pictures = open_pictures(tmp_path / "waved.mcap")
    assert len(pictures) == sum(heard) == int(np.ceil(robot.camera.rate))
    assert pictures.inertia is not None
    assert np.diff(pictures.inertia.stamp_ns) == pytest.approx(1e9 / robot.imu.rate, abs=2)
    detector = GridDetector(GRID)
    seen = [max(len(detector.detect(eye) or ()) for eye in eyes if eye is not None) for _, _, eyes in pictures]
    assert max(seen) > 40


def test_the_rig_is_off_the_described_one_by_a_little() -> None:
    robot = small_eyed()
    truth = built_askew(robot, np.random.default_rng(1))
    left = StereoCalibration.of_robot(robot).left
    described = left.body_from_camera.inverse() @ robot.imu.body_from_imu
    apart = rotation_log(truth.camera_from_imu.rotation @ described.rotation.T)
    assert 0.1 < np.degrees(np.linalg.norm(apart)) < 3.0
    assert truth.rig.baseline == pytest.approx(robot.camera.baseline, abs=3e-3)
    ahead = np.array([[0.1, 0.05, 1.0]])
    assert np.linalg.norm(project(truth.rig.cameras[0], ahead) - project(left, ahead)) < 10.0


def test_the_truth_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(study_calibration, "load_robot", lambda _name: small_eyed())
    path = tmp_path / "waved.mcap"
    assert study_calibration.main(["--record", str(path), "--seconds", "5", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["recording"] == str(path)
    assert path.is_file()
    assert report["baseline_mm"] == pytest.approx(100.0, abs=3.0)
    with pytest.raises(InputError, match="valid are 5 to 120"):
        study_calibration.main(["--record", str(path), "--seconds", "1"])
