"""Kalibr's files out and in again, and sentences about what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from robot_agent.calibration.kalibr_files import (
    read_imu,
    read_target,
    write_camchain,
    write_imu,
    write_target,
)
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.target import AprilGrid, Checkerboard, Target
from robot_agent.vision.camchain import read_camchain, read_chain
from sim_agent.targets.recording import draw_rig
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot


@pytest.mark.parametrize(
    "target",
    [
        AprilGrid(columns=6, rows=5, tag_size=0.055, spacing=0.3),
        Checkerboard(columns=9, rows=6, column_spacing=0.025, row_spacing=0.03),
    ],
)
def test_a_target_comes_back_as_it_was(target: Target, tmp_path: Path) -> None:
    write_target(target, tmp_path / "target.yaml")
    assert read_target(tmp_path / "target.yaml") == target


@pytest.mark.parametrize("model", ["radtan", "equidistant"])
def test_a_rig_with_its_imu_comes_back_as_it_was(model: str, tmp_path: Path) -> None:
    truth = draw_rig(np.random.default_rng(5), model)
    write_camchain(truth.rig, tmp_path / "camchain.yaml", truth.camera_from_imu, truth.time_offset)
    chain = read_chain(tmp_path / "camchain.yaml")
    rig = Rig.of(chain.cameras)
    assert rig.models == truth.rig.models
    assert rig.sizes == truth.rig.sizes
    np.testing.assert_array_equal(rig.intrinsics, truth.rig.intrinsics)
    np.testing.assert_allclose(rig.eye_from_first[1].matrix, truth.rig.eye_from_first[1].matrix, atol=1e-12)
    assert chain.camera_from_imu is not None
    np.testing.assert_allclose(chain.camera_from_imu.matrix, truth.camera_from_imu.matrix, atol=1e-12)
    assert chain.time_offset == truth.time_offset
    assert read_camchain(tmp_path / "camchain.yaml").time_offset == truth.time_offset


def test_the_second_eyes_entries_are_kalibrs(tmp_path: Path) -> None:
    truth = draw_rig(np.random.default_rng(6), "radtan")
    write_camchain(truth.rig, tmp_path / "camchain.yaml", truth.camera_from_imu, truth.time_offset)
    second = yaml.safe_load((tmp_path / "camchain.yaml").read_text())["cam1"]
    first_point, imu_point = np.array([0.1, 0.2, 1.0, 1.0]), truth.camera_from_imu.inverse().transform([0.1, 0.2, 1.0])
    np.testing.assert_allclose(
        np.array(second["T_cn_cnm1"]) @ first_point, np.array(second["T_cam_imu"]) @ np.append(imu_point, 1.0)
    )


def test_an_imu_comes_back_as_it_was(tmp_path: Path) -> None:
    imu = load_robot("weaver").imu.model_copy(update={"position_in_body": (0.0, 0.0, 0.0)})
    write_imu(imu, tmp_path / "imu.yaml")
    assert read_imu(tmp_path / "imu.yaml") == imu
    nested = {"imu0": yaml.safe_load((tmp_path / "imu.yaml").read_text())}
    (tmp_path / "nested.yaml").write_text(yaml.safe_dump(nested))
    assert read_imu(tmp_path / "nested.yaml") == imu


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"target_type": "circlegrid"}, "'circlegrid' is unknown; valid are aprilgrid, checkerboard"),
        ({"target_type": "aprilgrid", "tagCols": 6, "tagRows": 6, "tagSpacing": 0.3}, "tagSize is missing"),
        ({"target_type": "aprilgrid", "tagCols": 6, "tagRows": 6, "tagSize": "big"}, "tagSize has to be a number"),
        ({"target_type": "aprilgrid", "tagCols": 6, "tagRows": 6, "tagSize": -1, "tagSpacing": 0.3}, "no target"),
    ],
)
def test_a_wrong_target_file_is_refused(entry: dict[str, object], message: str, tmp_path: Path) -> None:
    (tmp_path / "target.yaml").write_text(yaml.safe_dump(entry))
    with pytest.raises(InputError, match=message):
        read_target(tmp_path / "target.yaml")


def test_files_that_are_not_there_or_no_yaml_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="can not be read as Kalibr's target"):
        read_target(tmp_path / "missing.yaml")
    (tmp_path / "broken.yaml").write_text("a: [1")
    with pytest.raises(InputError, match="can not be read as Kalibr's imu"):
        read_imu(tmp_path / "broken.yaml")
    (tmp_path / "imu.yaml").write_text(
        "update_rate: 0\n"
        + "".join(
            f"{kind}_{what}: 1e-3\n"
            for kind in ("gyroscope", "accelerometer")
            for what in ("noise_density", "random_walk")
        )
    )
    with pytest.raises(InputError, match="update_rate has to be above zero"):
        read_imu(tmp_path / "imu.yaml")
