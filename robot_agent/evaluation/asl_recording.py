"""Stereo-inertial recordings in ASL (EuRoC) folders: mav0/cam0, cam1, imu0, each data.csv and sensor.yaml."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.evaluation.trajectory import Trajectory, read_tum
from robot_agent.vision.camera import Distortion, PinholeCamera, StereoCalibration
from weaver_shared.errors import InputError
from weaver_shared.messages import ImuBatch, StereoFrame
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose

DISTORTIONS: dict[str, Distortion] = {
    "radial-tangential": "radtan",
    "radtan": "radtan",
    "equidistant": "equidistant",
    "none": "none",
}

SAME_INSTANT_NS = 2_000_000
"""Pictures of both eyes within this are one pair."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AslRecording:
    """A readable recording; pictures are only loaded when they are asked for."""

    calibration: StereoCalibration
    imu: Imu
    body_from_imu: Pose
    inertia: ImuBatch
    pictures: tuple[tuple[int, Path | None, Path | None], ...]  # stamp (ns), left, right
    truth: Trajectory | None

    def __len__(self) -> int:
        return len(self.pictures)

    def __iter__(self) -> Iterator[tuple[StereoFrame, ImuBatch]]:
        """Each pair with the inertia up to it; an eye that is missing is an empty picture."""
        parts = inertia_up_to(self.inertia, [stamp for stamp, _, _ in self.pictures])
        for sequence, ((stamp, left, right), part) in enumerate(zip(self.pictures, parts, strict=True)):
            yield StereoFrame(stamp_ns=stamp, sequence=sequence, left=_picture(left), right=_picture(right)), part


def open_asl(folder: Path) -> AslRecording:
    """Raises InputError that names what is missing or malformed in `folder`, which may be mav0 or its parent."""
    if not folder.is_dir():
        raise InputError(f"{folder} is not a folder; a recording has mav0/cam0, mav0/cam1 and mav0/imu0 in it")
    root = folder / "mav0" if (folder / "mav0").is_dir() else folder
    missing = [name for name in ("cam0", "cam1", "imu0") if not (root / name / "sensor.yaml").is_file()]
    if missing:
        raise InputError(f"{folder} is not an ASL recording: {', '.join(missing)} has no sensor.yaml under {root}")
    left, right = (_camera(root / name / "sensor.yaml") for name in ("cam0", "cam1"))
    imu, body_from_imu = _imu(root / "imu0" / "sensor.yaml")
    inertia = _inertia(root / "imu0" / "data.csv")
    pictures = _pairs(_listing(root / "cam0"), _listing(root / "cam1"))
    if not pictures:
        raise InputError(f"{folder} has no pictures in {root / 'cam0'}")
    return AslRecording(
        calibration=StereoCalibration(left=left, right=right),
        imu=imu,
        body_from_imu=body_from_imu,
        inertia=inertia,
        pictures=pictures,
        truth=_truth(folder, root),
    )


def inertia_up_to(inertia: ImuBatch, stamps_ns: list[int]) -> Iterator[ImuBatch]:
    """The samples between consecutive instants; one beyond each comes along: it says what happened right up to it."""
    begin = 0
    for stamp in stamps_ns:
        end = min(int(np.searchsorted(inertia.stamp_ns, stamp, side="left")) + 1, len(inertia.stamp_ns))
        end = max(begin, end)
        yield _part(inertia, begin, end)
        begin = end


def _pairs(left: dict[int, Path], right: dict[int, Path]) -> tuple[tuple[int, Path | None, Path | None], ...]:
    """Every instant at which an eye looked, in order."""
    rights = np.array(sorted(right), dtype=np.int64)
    pairs: dict[int, tuple[Path | None, Path | None]] = {}
    used: set[int] = set()
    for stamp, path in left.items():
        near = int(rights[np.argmin(np.abs(rights - stamp))]) if len(rights) else None
        matches = near is not None and abs(near - stamp) <= SAME_INSTANT_NS
        pairs[stamp] = (path, right[near] if matches and near is not None else None)
        if matches and near is not None:
            used.add(near)
    pairs.update({stamp: (None, path) for stamp, path in right.items() if stamp not in used})
    return tuple((stamp, *pairs[stamp]) for stamp in sorted(pairs))


def _listing(camera: Path) -> dict[int, Path]:
    """Pictures that are there, by stamp: from data.csv and, as lists are not always complete, from the folder."""
    found = {int(path.stem): path for path in (camera / "data").glob("*.png") if path.stem.isdigit()}
    table = camera / "data.csv"
    if table.is_file():
        for line in table.read_text().splitlines():
            stamp, _, name = line.strip().partition(",")
            path = camera / "data" / name.strip()
            if stamp.isdigit() and path.is_file():
                found[int(stamp)] = path
    return dict(sorted(found.items()))


def _picture(path: Path | None) -> NDArray[np.uint8]:
    """Grey values, or an empty picture where there is none or it can not be decoded."""
    picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) if path is not None else None
    return np.zeros((0, 0), dtype=np.uint8) if picture is None else np.asarray(picture, dtype=np.uint8)


def _inertia(path: Path) -> ImuBatch:
    try:
        lines = [line.split(",") for line in path.read_text().splitlines() if line[:1].isdigit()]
        stamps = np.array([int(line[0]) for line in lines], dtype=np.int64)
        table = np.array([[float(x) for x in line[1:7]] for line in lines])
    except (OSError, ValueError) as error:
        raise InputError(f"{path} can not be read as stamp, 3 angular velocities, 3 accelerations: {error}") from error
    if table.ndim != 2 or table.shape[1] != 6 or len(table) < 2:
        raise InputError(f"{path} holds no table of stamp, 3 angular velocities, 3 accelerations")
    return interval_means(
        ImuBatch(stamp_ns=stamps, angular_velocity_in_imu=table[:, :3], specific_force_in_imu=table[:, 3:])
    )


def interval_means(instants: ImuBatch) -> ImuBatch:
    """Samples taken at instants as means over the intervals between them: without it, everything lags half a sample."""

    def means(rows: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(0.5 * (rows + np.concatenate([rows[:1], rows[:-1]])))

    return ImuBatch(
        stamp_ns=instants.stamp_ns,
        angular_velocity_in_imu=means(instants.angular_velocity_in_imu),
        specific_force_in_imu=means(instants.specific_force_in_imu),
    )


def _part(batch: ImuBatch, begin: int, end: int) -> ImuBatch:
    return ImuBatch(
        stamp_ns=batch.stamp_ns[begin:end],
        angular_velocity_in_imu=batch.angular_velocity_in_imu[begin:end],
        specific_force_in_imu=batch.specific_force_in_imu[begin:end],
    )


def _camera(path: Path) -> PinholeCamera:
    text = path.read_text()
    model = _word(text, "distortion_model", path)
    if model not in DISTORTIONS:
        raise InputError(f"{path}: distortion_model {model!r} is unknown; known are {', '.join(DISTORTIONS)}")
    width, height = _numbers(text, "resolution", 2, path)
    fx, fy, cx, cy = _numbers(text, "intrinsics", 4, path)
    coefficients = _numbers(text, "distortion_coefficients", 4, path) if model != "none" else [0.0] * 4
    return PinholeCamera(
        width=int(width),
        height=int(height),
        fx=fx,
        fy=fy,
        cx=cx,
        cy=cy,
        distortion_model=DISTORTIONS[model],
        distortion=np.array(coefficients),
        body_from_camera=_body_from_sensor(text, path),
    )


def _imu(path: Path) -> tuple[Imu, Pose]:
    text = path.read_text()
    body_from_imu = _body_from_sensor(text, path)
    x, y, z = body_from_imu.position
    imu = Imu(
        position_in_body=(x, y, z),
        rate=_number(text, "rate_hz", path),
        gyro_noise_density=_number(text, "gyroscope_noise_density", path),
        gyro_random_walk=_number(text, "gyroscope_random_walk", path),
        accel_noise_density=_number(text, "accelerometer_noise_density", path),
        accel_random_walk=_number(text, "accelerometer_random_walk", path),
    )
    return imu, body_from_imu


def _body_from_sensor(text: str, path: Path) -> Pose:
    found = re.search(r"T_BS:.*?data:\s*\[(.*?)\]", text, re.DOTALL)
    numbers = [float(x) for x in found.group(1).split(",")] if found else []
    if len(numbers) != 16:
        raise InputError(f"{path}: T_BS needs 16 numbers, found {len(numbers)}")
    matrix = np.array(numbers).reshape(4, 4)
    u, _, vt = np.linalg.svd(matrix[:3, :3])  # the file's digits are rounded
    return Pose(rotation=u @ vt, position=matrix[:3, 3])


def _numbers(text: str, key: str, count: int, path: Path) -> list[float]:
    found = re.search(rf"^{key}:\s*\[(.*?)\]", text, re.MULTILINE | re.DOTALL)
    numbers = [float(x) for x in found.group(1).split(",")] if found else []
    if len(numbers) != count:
        raise InputError(f"{path}: {key} needs {count} numbers, found {len(numbers)}")
    return numbers


def _number(text: str, key: str, path: Path) -> float:
    return float(_word(text, key, path))


def _word(text: str, key: str, path: Path) -> str:
    found = re.search(rf"^{key}:\s*([^\s#]+)", text, re.MULTILINE)
    if not found:
        raise InputError(f"{path}: {key} is missing")
    return found.group(1)


def _truth(folder: Path, root: Path) -> Trajectory | None:
    for path in (folder / "groundtruth_tum.txt", root / "groundtruth_tum.txt"):
        if path.is_file():
            return read_tum(path)
    table_path = root / "state_groundtruth_estimate0" / "data.csv"
    if not table_path.is_file():
        return None
    lines = [line.split(",") for line in table_path.read_text().splitlines() if line[:1].isdigit()]
    table = np.array([[float(x) for x in line[1:8]] for line in lines])
    stamps = np.array([int(line[0]) for line in lines], dtype=np.int64)
    return Trajectory(stamp_ns=stamps, position=table[:, :3], wxyz=table[:, 3:7])
