"""`weaver odometry` over a made recording: errors as evo gives them, plots, another calibration, no ground truth."""

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from made_recording import FRAMES, write_chain, write_recording

from robot_agent.command_line.odometry import main
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.errors import InputError
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

Run = Callable[..., dict[str, Any]]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory, robot: RobotDescription, calibration: StereoCalibration) -> Path:
    return write_recording(tmp_path_factory.mktemp("made"), robot, calibration)


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def _run(*arguments: str | Path) -> dict[str, Any]:
        assert main([*map(str, arguments), "--json", "--quiet"]) == 0
        report: dict[str, Any] = json.loads(capsys.readouterr().out)
        return report

    return _run


def test_a_walk_is_followed_and_judged_as_evo_does(made: Path, run: Run, tmp_path: Path) -> None:
    pytest.importorskip("evo")
    report = run(made, "--plots", tmp_path / "plots")
    assert report["frames"] == FRAMES
    assert report["ate_m"] < 0.005
    # evo may turn the path freely, we only about the vertical: its error is never the greater one.
    assert 0.0 < report["evo"]["ate_rmse"] <= report["ate_m"] + 1e-6
    assert report["evo"]["ate_max"] < 0.02
    assert abs(report["time_offset_s"]) < 0.002
    assert np.linalg.norm(report["mounting_turn_deg"]) < 0.1
    for name in ("path.png", "errors.png"):
        plot = cv2.imread(str(tmp_path / "plots" / name))
        assert plot is not None
        assert plot.std() > 1.0


def test_without_ground_truth_there_is_a_path_but_no_error(made: Path, run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "untold"
    shutil.copytree(made / "mav0", folder / "mav0")
    report = run(folder, "--plots", tmp_path / "plots")
    assert report["ate_m"] is None
    assert report["evo"] is None
    assert report["estimated_path_length"] > 0.2
    assert (tmp_path / "plots" / "path.png").is_file()
    assert not (tmp_path / "plots" / "errors.png").exists()


def test_kalibrs_calibration_takes_the_place_of_the_recordings_own(
    made: Path, run: Run, tmp_path: Path, robot: RobotDescription, calibration: StereoCalibration
) -> None:
    right = run(made, "--calibration", write_chain(tmp_path / "right.yaml", robot, calibration))
    assert right["ate_m"] < 0.005
    left, other = calibration.left.body_from_camera, calibration.right.body_from_camera
    farther = Pose(rotation=other.rotation, position=left.position + 1.2 * (other.position - left.position))
    wide = replace(calibration, right=replace(calibration.right, body_from_camera=farther))
    wrong = run(made, "--calibration", write_chain(tmp_path / "wide.yaml", robot, wide))
    assert wrong["estimated_path_length"] > 1.05 * right["estimated_path_length"]


def test_a_calibration_that_does_not_know_the_imu_is_refused(
    made: Path, tmp_path: Path, robot: RobotDescription, calibration: StereoCalibration
) -> None:
    chain = write_chain(tmp_path / "eyes.yaml", robot, calibration, with_imu=False)
    with pytest.raises(InputError, match="T_cam_imu is missing"):
        main([str(made), "--calibration", str(chain), "--json", "--quiet"])


def test_an_eye_without_a_folder_is_refused(made: Path, tmp_path: Path) -> None:
    folder = tmp_path / "one-eyed"
    shutil.copytree(made, folder)
    shutil.rmtree(folder / "mav0" / "cam1")
    with pytest.raises(InputError, match=r"cam1 has no sensor\.yaml"):
        main([str(folder), "--json", "--quiet"])


def test_an_eye_without_pictures_is_said(made: Path, run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "covered"
    shutil.copytree(made, folder)
    shutil.rmtree(folder / "mav0" / "cam1" / "data")
    report = run(folder)
    assert report["quality"] == "degraded"
    assert "right picture missing" in report["reason"]


def test_plots_that_can_not_be_written_are_refused(made: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match="plots can not be written"):
        main([str(made), "--plots", str(tmp_path / "file"), "--json", "--quiet"])
