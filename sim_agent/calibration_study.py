"""Calibrates made-up rigs from rendered pictures of a waved AprilGrid, and compares with the truth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.camera_calibration import calibrate_cameras, spread_views
from robot_agent.calibration.grid_detector import GridDetector
from robot_agent.calibration.inertial_calibration import calibrate_imu
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.sightings import Session, View
from robot_agent.calibration.target import AprilGrid
from robot_agent.vision.camera import Distortion
from robot_agent.vision.distortion import normalise, project
from sim_agent.targets.motion import HandHeldMotion
from sim_agent.targets.recording import TargetRecording, draw_rig
from weaver_shared.robots import load_robot
from weaver_shared.transforms import rotation_log

GRID = AprilGrid(columns=6, rows=6, tag_size=0.055, spacing=0.3)
DISTANCE = 0.55
CAMERA_VIEWS = 100
RATE = 10.0
"""Pictures a second."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationRun:
    """Errors of one recording against its truth, each beside the standard deviation the calibration itself gives."""

    seed: int
    model: Distortion
    pictures: int
    corner_sigma_px: float
    focal_error_percent: float  # of all four focal lengths, the worst
    focal_sigma_percent: float
    centre_error_px: float
    field_error_px: float  # of the whole lens over the picture, best turn removed: rms
    baseline_error_mm: float
    baseline_sigma_mm: float
    stereo_rotation_error_deg: float
    imu_rotation_error_deg: float
    imu_rotation_sigma_deg: float
    imu_translation_error_mm: float
    imu_translation_sigma_mm: float
    time_offset_error_us: float
    time_offset_sigma_us: float

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def calibrate_rendered(
    seed: int, model: Distortion, seconds: float, progress: Callable[[int], None] = lambda _: None
) -> CalibrationRun:
    """One recording of `seconds` at 10 Hz, from pictures to the camera-IMU result; the truth is only compared with."""
    generator = np.random.default_rng(seed)
    truth = draw_rig(generator, model)
    imu = load_robot("weaver").imu
    motion = HandHeldMotion(GRID, DISTANCE, generator)
    recording = TargetRecording(truth, GRID, motion, imu, generator, seconds=seconds, rate=RATE)
    detector = GridDetector(GRID)
    views = []
    for stamp_ns, pictures in recording:
        views.append(View(stamp_ns=stamp_ns, eyes=tuple(detector.detect(picture) for picture in pictures)))
        progress(1)
    session = Session(views=spread_views(views, CAMERA_VIEWS), sizes=truth.rig.sizes, pictures=len(views))
    cameras = calibrate_cameras(session, GRID, model)
    inertial = calibrate_imu(cameras.rig, views, GRID, recording.inertia, imu)
    imu_from_camera = truth.camera_from_imu.inverse()
    second, second_truth = cameras.rig.eye_from_first[1], truth.rig.eye_from_first[1]
    focal = cameras.rig.intrinsics[:, :2] / truth.rig.intrinsics[:, :2] - 1.0
    places = cameras.covariance[-6:, -6:]
    along = np.concatenate([np.zeros(3), second.position / cameras.rig.baseline])
    return CalibrationRun(
        seed=seed,
        model=model,
        pictures=len(views),
        corner_sigma_px=cameras.sigma,
        focal_error_percent=100.0 * float(np.abs(focal).max()),
        focal_sigma_percent=100.0 * float((cameras.intrinsics_sigma[:, :2] / truth.rig.intrinsics[:, :2]).max()),
        centre_error_px=float(np.abs(cameras.rig.intrinsics[:, 2:4] - truth.rig.intrinsics[:, 2:4]).max()),
        field_error_px=max(field_error(cameras.rig, truth.rig, eye) for eye in range(2)),
        baseline_error_mm=1e3 * abs(cameras.rig.baseline - truth.rig.baseline),
        baseline_sigma_mm=1e3 * float(np.sqrt(along @ places @ along)),
        stereo_rotation_error_deg=_degrees(second.rotation.T @ second_truth.rotation),
        imu_rotation_error_deg=_degrees(inertial.imu_from_camera.rotation.T @ imu_from_camera.rotation),
        imu_rotation_sigma_deg=float(np.degrees(np.linalg.norm(inertial.rotation_sigma))),
        imu_translation_error_mm=1e3
        * float(np.linalg.norm(inertial.imu_from_camera.position - imu_from_camera.position)),
        imu_translation_sigma_mm=1e3 * float(np.linalg.norm(inertial.position_sigma)),
        time_offset_error_us=1e6 * abs(inertial.time_offset - truth.time_offset),
        time_offset_sigma_us=1e6 * inertial.time_offset_sigma,
    )


def field_error(found: Rig, truth: Rig, eye: int) -> float:
    """How far the same rays land apart in the picture, rms in px, after the turn that explains most of it."""
    width, height = truth.sizes[eye]
    x, y = np.meshgrid(np.linspace(0, width - 1, 17), np.linspace(0, height - 1, 13))
    pixels = np.stack([x.ravel(), y.ravel()], axis=1)
    rays = _directions(normalise(truth.cameras[eye], pixels))
    seen = _directions(normalise(found.cameras[eye], pixels))
    u, _, vt = np.linalg.svd(seen.T @ rays)
    turned = rays @ (u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt).T
    return float(np.sqrt(((project(found.cameras[eye], turned) - pixels) ** 2).sum(axis=1).mean()))


def _directions(points: NDArray[np.float64]) -> NDArray[np.float64]:
    rays = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    return np.asarray(rays / np.linalg.norm(rays, axis=1, keepdims=True))


def _degrees(rotation: NDArray[np.float64]) -> float:
    return float(np.degrees(np.linalg.norm(rotation_log(rotation))))
