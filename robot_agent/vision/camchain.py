"""Calibrations from Kalibr's `camchain.yaml`: cam0 is the left eye, cam1 the right one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from robot_agent.vision.camera import Distortion, PinholeCamera, StereoCalibration
from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose

MODELS: dict[str, Distortion] = {"none": "none", "radtan": "radtan", "equidistant": "equidistant"}


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraChain:
    """One or more eyes in the first one's optical frame, and the IMU where the file tells of it."""

    cameras: tuple[PinholeCamera, ...]
    camera_from_imu: Pose | None = None
    time_offset: float = 0.0  # s, added to a picture's stamp to get the IMU's time


def read_camchain(path: Path) -> StereoCalibration:
    """The pair in the left eye's optical frame. Raises InputError naming the key, what was found and what is valid."""
    chain = read_chain(path)
    if len(chain.cameras) < 2:
        raise InputError(f"{path}: cam1 is missing; a stereo pair needs both cam0 and cam1")
    return StereoCalibration(left=chain.cameras[0], right=chain.cameras[1], time_offset=chain.time_offset)


def read_camchain_on_imu(path: Path) -> StereoCalibration:
    """The pair in the IMU's frame, with the time offset. Raises InputError when the file does not know the IMU."""
    pair, chain = read_camchain(path), read_chain(path)
    if chain.camera_from_imu is None:
        raise InputError(f"{path}: cam0: T_cam_imu is missing; odometry needs the cameras' place on the IMU")
    imu_from_left = chain.camera_from_imu.inverse()
    return StereoCalibration(
        left=replace(pair.left, body_from_camera=imu_from_left),
        right=replace(pair.right, body_from_camera=imu_from_left @ pair.right.body_from_camera),
        time_offset=chain.time_offset,
    )


def read_chain(path: Path) -> CameraChain:
    """All eyes of the file, cam0 first. Raises InputError as `read_camchain` does."""
    try:
        document = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = str(error).splitlines()[0]
        raise InputError(f"{path} can not be read as Kalibr's camchain.yaml: {reason}") from error
    if not isinstance(document, dict) or not isinstance(document.get("cam0"), dict):
        raise InputError(f"{path}: cam0 is missing; a camchain.yaml has cam0 and cam1")
    first = document["cam0"]
    cameras = [_camera(first, Pose.identity(), f"{path}: cam0")]
    while isinstance(entry := document.get(f"cam{len(cameras)}"), dict):
        where = f"{path}: cam{len(cameras)}"
        next_from_last = _pose(_numbers(entry, "T_cn_cnm1", (4, 4), where), f"{where}: T_cn_cnm1")
        cameras.append(_camera(entry, cameras[-1].body_from_camera @ next_from_last.inverse(), where))
    told = "T_cam_imu" in first
    where = f"{path}: cam0"
    return CameraChain(
        cameras=tuple(cameras),
        camera_from_imu=_pose(_numbers(first, "T_cam_imu", (4, 4), where), f"{where}: T_cam_imu") if told else None,
        time_offset=float(_numbers(first, "timeshift_cam_imu", (), where)) if "timeshift_cam_imu" in first else 0.0,
    )


def _camera(entry: dict[str, Any], left_from_camera: Pose, where: str) -> PinholeCamera:
    model = entry.get("camera_model", "pinhole")
    if model != "pinhole":
        raise InputError(f"{where}: camera_model {model!r} is unknown; valid is pinhole")
    distortion = entry.get("distortion_model", "none")
    if distortion not in MODELS:
        raise InputError(f"{where}: distortion_model {distortion!r} is unknown; valid are {', '.join(MODELS)}")
    width, height = _numbers(entry, "resolution", (2,), where)
    fx, fy, cx, cy = _numbers(entry, "intrinsics", (4,), where)
    if min(width, height, fx, fy) <= 0.0:
        raise InputError(f"{where}: resolution and focal lengths have to be above zero")
    coefficients = np.zeros(4) if distortion == "none" else _numbers(entry, "distortion_coeffs", (4,), where)
    return PinholeCamera(
        width=int(width),
        height=int(height),
        fx=float(fx),
        fy=float(fy),
        cx=float(cx),
        cy=float(cy),
        distortion_model=MODELS[distortion],
        distortion=coefficients,
        body_from_camera=left_from_camera,
    )


def _numbers(entry: dict[str, Any], key: str, shape: tuple[int, ...], where: str) -> NDArray[np.float64]:
    try:
        numbers = np.array(entry[key], dtype=np.float64)
    except KeyError as error:
        raise InputError(f"{where}: {key} is missing") from error
    except (TypeError, ValueError) as error:
        raise InputError(f"{where}: {key} has to be numbers, found {entry[key]!r:.60}") from error
    if numbers.shape != shape or not np.isfinite(numbers).all():
        count = f"{'x'.join(map(str, shape))} numbers" if shape else "a number"
        raise InputError(f"{where}: {key} has to be {count}, found {entry[key]!r:.60}")
    return numbers


def _pose(matrix: NDArray[np.float64], where: str) -> Pose:
    u, singular, vt = np.linalg.svd(matrix[:3, :3])  # the file's digits are rounded
    if abs(singular - 1.0).max() > 1e-3 or np.linalg.det(u @ vt) < 0.0:
        raise InputError(f"{where} is no rigid transform")
    return Pose(rotation=u @ vt, position=matrix[:3, 3])
