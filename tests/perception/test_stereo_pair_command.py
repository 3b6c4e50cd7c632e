"""`weaver terrain LEFT --right RIGHT --calibration FILE`: one pair of pictures by itself."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml
from raycast_scene import Scene, standing

from robot_agent.command_line import terrain
from robot_agent.vision.camchain import read_camchain
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot

CALIBRATION = StereoCalibration.of_robot(load_robot())


def box(x, y):
    return np.where((np.abs(x - 0.75) < 0.15) & (np.abs(y) < 0.15), 0.06, 0.0)


def camchain() -> dict[str, dict[str, object]]:
    left, right = CALIBRATION.left, CALIBRATION.right
    eye = {
        "camera_model": "pinhole",
        "intrinsics": [left.fx, left.fy, left.cx, left.cy],
        "distortion_model": "radtan",
        "distortion_coeffs": [0.0, 0.0, 0.0, 0.0],
        "resolution": [left.width, left.height],
    }
    right_from_left = right.body_from_camera.inverse() @ left.body_from_camera
    return {"cam0": dict(eye), "cam1": {**eye, "T_cn_cnm1": right_from_left.matrix.tolist()}}


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pair")
    frame = Scene.of(box).frame(standing())
    cv2.imwrite(str(folder / "left.png"), frame.left)
    cv2.imwrite(str(folder / "right.png"), frame.right)
    (folder / "camchain.yaml").write_text(yaml.safe_dump(camchain()))
    return folder


def options(pair: Path, left: str = "left.png", right: str = "right.png") -> list[str]:
    return [str(pair / left), "--right", str(pair / right), "--calibration", str(pair / "camchain.yaml"), "--json"]


def test_a_pair_of_pictures_shows_level_ground_and_the_box_on_it(pair: Path, capsys: pytest.CaptureFixture[str]):
    assert terrain.main(options(pair)) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["kind"] == "cloud"
    camera_up = CALIBRATION.left.body_from_camera.rotation.T @ np.array([0.0, 0.0, 1.0])
    angle = np.degrees(np.arccos(np.dot(report["plane"]["normal_in_input"], camera_up)))
    assert angle < 0.5
    assert any(abs(height - 0.06) < 0.01 for height in report["steps"])


def test_swapped_eyes_are_refused_rather_than_taken_for_ground(pair: Path):
    with pytest.raises(InputError, match="pair can not be used"):
        terrain.main(options(pair, "right.png", "left.png"))


def test_a_black_eye_is_refused(pair: Path):
    cv2.imwrite(str(pair / "black.png"), np.zeros((480, 640), dtype=np.uint8))
    with pytest.raises(InputError, match="contrast"):
        terrain.main(options(pair, right="black.png"))


def test_a_pair_needs_both_pictures_and_a_calibration(pair: Path):
    with pytest.raises(InputError, match="--calibration"):
        terrain.main([str(pair / "left.png"), "--right", str(pair / "right.png")])
    with pytest.raises(InputError, match=r"missing\.png is not a file"):
        terrain.main(options(pair, right="missing.png"))
    with pytest.raises(InputError, match="can not be read as a picture"):
        terrain.main(options(pair, right="camchain.yaml"))


def test_a_picture_of_another_size_is_named_with_both_sizes(pair: Path):
    cv2.imwrite(str(pair / "small.png"), np.zeros((240, 320), dtype=np.uint8))
    with pytest.raises(InputError, match="320x240 px, its calibration is for 640x480"):
        terrain.main(options(pair, right="small.png"))


@pytest.mark.parametrize(
    ("camera", "key", "value", "sentence"),
    [
        ("cam1", "T_cn_cnm1", None, "T_cn_cnm1 has to be numbers|T_cn_cnm1 has to be 4x4"),
        ("cam1", "T_cn_cnm1", (2.0 * np.eye(4)).tolist(), "no rigid transform"),
        ("cam0", "intrinsics", [1.0, 2.0], "intrinsics has to be 4 numbers"),
        ("cam0", "intrinsics", [-1.0, 2.0, 3.0, 4.0], "above zero"),
        ("cam0", "distortion_model", "fov", "valid are none, radtan, equidistant"),
        ("cam0", "camera_model", "omni", "valid is pinhole"),
    ],
)
def test_a_wrong_calibration_is_named_by_its_key(tmp_path: Path, camera: str, key: str, value: object, sentence: str):
    document = camchain()
    document[camera][key] = value
    path = tmp_path / "camchain.yaml"
    path.write_text(yaml.safe_dump(document))
    with pytest.raises(InputError, match=sentence):
        read_camchain(path)


def test_a_calibration_keeps_the_pair_it_was_written_from(pair: Path):
    read = read_camchain(pair / "camchain.yaml")
    baseline = read.right.body_from_camera.position
    assert baseline == pytest.approx([load_robot().camera.baseline, 0.0, 0.0], abs=1e-12)
