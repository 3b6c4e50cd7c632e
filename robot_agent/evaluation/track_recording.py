"""Recordings of monocular feature tracks and inertia in one table (gtsam's `eqvio_processed` CSV)."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robot_agent.evaluation.asl_recording import inertia_up_to, interval_means
from robot_agent.evaluation.trajectory import nanoseconds
from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from weaver_shared.errors import InputError
from weaver_shared.messages import ImuBatch, StereoFrame
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose

Sightings = tuple[NDArray[np.int64], NDArray[np.float64]]

COLUMNS = ("row_type", "t_abs", "landmark_id", "gx", "ax", "u_norm", "v_norm", "key", "value")
CAMERA = ("camera_fx", "camera_fy", "camera_cx", "camera_cy")
MOUNT = ("T_ci_tx", "T_ci_ty", "T_ci_tz", "T_ci_qw", "T_ci_qx", "T_ci_qy", "T_ci_qz")
NO_PICTURE = np.zeros((0, 0), dtype=np.uint8)


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackRecording:
    calibration: StereoCalibration  # both eyes are the one camera; the right one never sees anything
    imu: Imu
    inertia: ImuBatch
    sightings: dict[int, Sightings]  # by stamp in ns: identities (n,), undistorted points (n, 2) on the plane z = 1

    def __len__(self) -> int:
        return len(self.sightings)

    def __iter__(self) -> Iterator[tuple[StereoFrame, ImuBatch]]:
        """Frames without pictures, each with the inertia up to it."""
        parts = inertia_up_to(self.inertia, list(self.sightings))
        for sequence, (stamp, part) in enumerate(zip(self.sightings, parts, strict=True)):
            yield StereoFrame(stamp_ns=stamp, sequence=sequence, left=NO_PICTURE, right=NO_PICTURE), part


def open_tracks(path: Path) -> TrackRecording:
    """Raises InputError that names what is missing or malformed."""
    try:
        with path.open(newline="") as file:
            table = csv.DictReader(file)
            missing = [name for name in COLUMNS if name not in (table.fieldnames or ())]
            if missing:
                raise InputError(f"{path} is not a table of tracks: it has no column {', '.join(missing)}")
            rows = list(table)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"tracks {path} can not be read: {error}") from error
    try:
        return _recording(path, rows)
    except (KeyError, ValueError, TypeError) as error:
        raise InputError(f"tracks {path} are malformed: {error}") from error


def _recording(path: Path, rows: list[dict[str, str]]) -> TrackRecording:
    meta = {row["key"]: row["value"] for row in rows if row["row_type"] == "meta"}
    unknown = [key for key in (*CAMERA, *MOUNT) if key not in meta]
    if unknown:
        raise InputError(f"tracks {path} lack the camera's {', '.join(unknown)}")
    inertia = _inertia([row for row in rows if row["row_type"] == "imu"])
    sightings = _sightings([row for row in rows if row["row_type"] == "vision_feature"])
    if not len(inertia.stamp_ns) or not sightings:
        raise InputError(f"tracks {path} hold {len(inertia.stamp_ns)} inertial samples and {len(sightings)} frames")
    camera = _camera({key: float(meta[key]) for key in (*CAMERA, *MOUNT)})
    return TrackRecording(
        calibration=StereoCalibration(left=camera, right=camera), imu=_imu(), inertia=inertia, sightings=sightings
    )


def _imu() -> Imu:
    """The ADIS16448 of EuRoC's vehicle; the table itself does not say.

    The sensor file of its recordings gives noise at rest; what rotors shake, sampled at instants, is three times that.
    """
    return Imu(
        position_in_body=(0.0, 0.0, 0.0),
        rate=200.0,
        gyro_noise_density=3.0 * 1.6968e-4,
        gyro_random_walk=1.9393e-5,
        accel_noise_density=3.0 * 2.0e-3,
        accel_random_walk=3.0e-3,
    )


def _camera(meta: dict[str, float]) -> PinholeCamera:
    """`T_ci` takes camera coordinates to the IMU's, as EuRoC's T_BS does; the picture's size is that of EuRoC."""
    return PinholeCamera(
        width=752,
        height=480,
        fx=meta["camera_fx"],
        fy=meta["camera_fy"],
        cx=meta["camera_cx"],
        cy=meta["camera_cy"],
        distortion_model="none",
        distortion=np.zeros(4),
        body_from_camera=Pose.of([meta[key] for key in MOUNT[:3]], [meta[key] for key in MOUNT[3:]]),
    )


def _inertia(rows: list[dict[str, str]]) -> ImuBatch:
    return interval_means(
        ImuBatch(
            stamp_ns=np.array([nanoseconds(row["t_abs"]) for row in rows], dtype=np.int64),
            angular_velocity_in_imu=np.array([[float(row[k]) for k in ("gx", "gy", "gz")] for row in rows]).reshape(
                -1, 3
            ),
            specific_force_in_imu=np.array([[float(row[k]) for k in ("ax", "ay", "az")] for row in rows]).reshape(
                -1, 3
            ),
        )
    )


def _sightings(rows: list[dict[str, str]]) -> dict[int, Sightings]:
    by_stamp: dict[int, list[tuple[int, float, float]]] = {}
    for row in rows:
        seen = (int(row["landmark_id"]), float(row["u_norm"]), float(row["v_norm"]))
        by_stamp.setdefault(nanoseconds(row["t_abs"]), []).append(seen)
    return {
        stamp: (np.array([s[0] for s in seen], dtype=np.int64), np.array([s[1:] for s in seen]))
        for stamp, seen in sorted(by_stamp.items())
    }
