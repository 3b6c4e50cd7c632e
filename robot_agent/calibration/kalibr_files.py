"""Kalibr's files: target.yaml, imu.yaml and camchain.yaml (which `robot_agent.vision.camchain` reads)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import yaml

from robot_agent.calibration.rig import Rig
from robot_agent.calibration.target import AprilGrid, Checkerboard, Target
from weaver_shared.errors import InputError
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose

IMU_KEYS = {
    "gyro_noise_density": "gyroscope_noise_density",
    "gyro_random_walk": "gyroscope_random_walk",
    "accel_noise_density": "accelerometer_noise_density",
    "accel_random_walk": "accelerometer_random_walk",
}


def read_target(path: Path) -> Target:
    """Raises InputError naming the key that is missing or wrong."""
    entry = _document(path, "target.yaml")
    kind = entry.get("target_type")
    if kind == "aprilgrid":
        return AprilGrid(
            columns=int(_number(entry, "tagCols", path)),
            rows=int(_number(entry, "tagRows", path)),
            tag_size=_number(entry, "tagSize", path),
            spacing=_number(entry, "tagSpacing", path),
        )
    if kind == "checkerboard":
        return Checkerboard(
            columns=int(_number(entry, "targetCols", path)),
            rows=int(_number(entry, "targetRows", path)),
            column_spacing=_number(entry, "colSpacingMeters", path),
            row_spacing=_number(entry, "rowSpacingMeters", path),
        )
    raise InputError(f"{path}: target_type {kind!r} is unknown; valid are aprilgrid, checkerboard")


def write_target(target: Target, path: Path) -> None:
    if isinstance(target, AprilGrid):
        entry: dict[str, Any] = {
            "target_type": "aprilgrid",
            "tagCols": target.columns,
            "tagRows": target.rows,
            "tagSize": target.tag_size,
            "tagSpacing": target.spacing,
        }
    else:
        entry = {
            "target_type": "checkerboard",
            "targetCols": target.columns,
            "targetRows": target.rows,
            "rowSpacingMeters": target.row_spacing,
            "colSpacingMeters": target.column_spacing,
        }
    path.write_text(yaml.safe_dump(entry, sort_keys=False), encoding="utf-8")


def read_imu(path: Path) -> Imu:
    """Rate (Hz), noise densities and random walks of an IMU, in SI units."""
    entry = _document(path, "imu.yaml")
    nested = entry.get("imu0")  # Kalibr's results have the sensor's name above
    if isinstance(nested, dict):
        entry = nested
    values = {name: _number(entry, key, path) for name, key in IMU_KEYS.items()}
    rate = _number(entry, "update_rate", path)
    for key, value in (*((IMU_KEYS[name], value) for name, value in values.items()), ("update_rate", rate)):
        if value <= 0.0:
            raise InputError(f"{path}: {key} has to be above zero, found {value}")
    return Imu(position_in_body=(0.0, 0.0, 0.0), rate=rate, **values)


def write_imu(imu: Imu, path: Path, topic: str = "/imu0") -> None:
    entry: dict[str, Any] = {key: float(getattr(imu, name)) for name, key in IMU_KEYS.items()}
    entry |= {"rostopic": topic, "update_rate": float(imu.rate)}
    path.write_text(yaml.safe_dump(entry, sort_keys=False), encoding="utf-8")


def write_camchain(rig: Rig, path: Path, camera_from_imu: Pose | None = None, time_offset: float = 0.0) -> None:
    """All eyes, each from the one before; with `camera_from_imu` also the IMU's place and the delay (s)."""
    document: dict[str, Any] = {}
    for eye, (model, intrinsics, size) in enumerate(zip(rig.models, rig.intrinsics, rig.sizes, strict=True)):
        entry: dict[str, Any] = {}
        if eye > 0:
            entry["T_cn_cnm1"] = _rows(rig.eye_from_first[eye] @ rig.eye_from_first[eye - 1].inverse())
        if camera_from_imu is not None:
            entry["T_cam_imu"] = _rows(rig.eye_from_first[eye] @ camera_from_imu)
            entry["timeshift_cam_imu"] = float(time_offset)
        entry |= {
            "cam_overlaps": [other for other in range(rig.eyes) if other != eye],
            "camera_model": "pinhole",
            "distortion_coeffs": [float(x) for x in intrinsics[4:]] if model != "none" else [],
            "distortion_model": model,
            "intrinsics": [float(x) for x in intrinsics[:4]],
            "resolution": list(size),
            "rostopic": f"/cam{eye}/image_raw",
        }
        document[f"cam{eye}"] = entry
    path.write_text(yaml.safe_dump(document, sort_keys=False, default_flow_style=None), encoding="utf-8")


def _rows(pose: Pose) -> list[list[float]]:
    return [[float(x) for x in row] for row in pose.matrix]


def _document(path: Path, what: str) -> dict[str, Any]:
    try:
        document = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise InputError(f"{path} can not be read as Kalibr's {what}: {str(error).splitlines()[0]}") from error
    if not isinstance(document, dict):
        raise InputError(f"{path} is not Kalibr's {what}: it holds no keys")
    return document


def _number(entry: dict[str, Any], key: str, path: Path) -> float:
    if key not in entry:
        raise InputError(f"{path}: {key} is missing")
    try:
        number = float(entry[key])
    except (TypeError, ValueError) as error:
        raise InputError(f"{path}: {key} has to be a number, found {entry[key]!r:.60}") from error
    if not np.isfinite(number):
        raise InputError(f"{path}: {key} has to be a number, found {entry[key]!r:.60}")
    return number
