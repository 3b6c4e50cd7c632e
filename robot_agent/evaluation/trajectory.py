"""How far an estimated trajectory is from the truth: alignment, absolute error, error at the end, drift."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose, rotation_exp, rotation_from_wxyz, rotation_log, rotation_z

Array = NDArray[np.float64]
Freedom = Literal["yaw", "se3"]

PATH_STEP = 0.05
"""m: the path is measured in steps of this length, so that neither sway nor the truth's noise makes it longer."""

LONGEST_TRUTH_GAP = 0.2
"""s between two true poses that may be interpolated."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trajectory:
    """Poses over time, in any world."""

    stamp_ns: NDArray[np.int64]  # (n,)
    position: Array  # (n, 3) m
    wxyz: Array  # (n, 4)

    def __len__(self) -> int:
        return len(self.stamp_ns)

    def pose_at(self, stamp_ns: int) -> Pose:
        """Interpolated. Raises InputError outside the trajectory."""
        _, poses = _interpolate(self, np.array([stamp_ns], dtype=np.int64))
        if not poses:
            raise InputError(f"the trajectory has no pose at {stamp_ns * 1e-9:.3f} s")
        return poses[0]

    def rotation(self, index: int) -> Array:
        return rotation_from_wxyz(self.wxyz[index])

    @staticmethod
    def of(stamps_ns: list[int], poses: list[Pose]) -> Trajectory:
        return Trajectory(
            stamp_ns=np.array(stamps_ns, dtype=np.int64),
            position=np.array([pose.position for pose in poses]).reshape(-1, 3),
            wxyz=np.array([pose.wxyz for pose in poses]).reshape(-1, 4),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class TrajectoryErrors:
    """Errors of the positions; NaN where they have no meaning."""

    ate_m: float  # root mean square distance after the best alignment
    final_error: float  # m, distance at the end when both begin at the same place and heading
    drift_percent: float  # final error per path length; NaN for a robot that stands
    path_length: float  # m
    final_rotation_deg: float  # turn between both at the end, likewise
    gravity_error_deg: float  # median angle between the down directions both see, needs no alignment
    matched: int  # poses compared


def evaluate(estimated: Trajectory, truth: Trajectory, freedom: Freedom = "yaw") -> TrajectoryErrors:
    """Compare at the estimate's stamps that the truth covers. Raises InputError when fewer than two are."""
    indices, true_poses = _interpolate(truth, estimated.stamp_ns)
    if len(indices) < 2:
        raise InputError(f"the ground truth covers {len(indices)} of {len(estimated)} estimated poses; 2 are needed")
    true_position = np.array([pose.position for pose in true_poses])
    position = estimated.position[indices]
    aligned = align(position, true_position, freedom)
    ate = float(np.sqrt(((aligned.transform(position) - true_position) ** 2).sum(axis=1).mean()))
    first = Pose(rotation=estimated.rotation(indices[0]), position=position[0])
    last = Pose(rotation=estimated.rotation(indices[-1]), position=position[-1])
    truth_from_world = same_heading(first, true_poses[0])
    final = truth_from_world @ last
    final_error = float(np.linalg.norm(final.position - true_poses[-1].position))
    length = path_length(true_position)
    down = np.array([estimated.rotation(i)[2] for i in indices])
    true_down = np.array([pose.rotation[2] for pose in true_poses])
    tilt = np.arctan2(np.linalg.norm(np.cross(down, true_down), axis=1), (down * true_down).sum(axis=1))
    return TrajectoryErrors(
        ate_m=ate,
        final_error=final_error,
        drift_percent=100.0 * final_error / length if length > 0.0 else float("nan"),
        path_length=length,
        final_rotation_deg=float(np.degrees(np.linalg.norm(rotation_log(final.rotation.T @ true_poses[-1].rotation)))),
        gravity_error_deg=float(np.degrees(np.median(tilt))),
        matched=len(indices),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """An estimated path laid over the true one, at the estimate's stamps that the truth covers."""

    stamp_ns: NDArray[np.int64]  # (n,)
    aligned: Array  # (n, 3) m
    truth: Array  # (n, 3) m


def errors_over_time(estimated: Trajectory, truth: Trajectory) -> Compared:
    """Aligned about the vertical. Raises InputError when the truth covers fewer than two poses."""
    indices, poses = _interpolate(truth, estimated.stamp_ns)
    if len(indices) < 2:
        raise InputError(f"the ground truth covers {len(indices)} of {len(estimated)} estimated poses; 2 are needed")
    true_position = np.array([pose.position for pose in poses])
    position = estimated.position[indices]
    return Compared(
        stamp_ns=estimated.stamp_ns[indices],
        aligned=align(position, true_position).transform(position),
        truth=true_position,
    )


def align(position: Array, truth: Array, freedom: Freedom = "yaw") -> Pose:
    """Least-squares pose that takes `position` (n, 3) to `truth` (n, 3): about the vertical, or freely (Umeyama 1991).

    Points that hardly spread say nothing about the rotation; they are only shifted.
    """
    centre, true_centre = position.mean(axis=0), truth.mean(axis=0)
    a, b = position - centre, truth - true_centre
    rotation = np.eye(3)
    if freedom == "yaw":
        sine = float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
        cosine = float((a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]).sum())
        if np.hypot(sine, cosine) > 0.0:
            rotation = rotation_z(float(np.arctan2(sine, cosine)))
    else:
        u, _, vt = np.linalg.svd(b.T @ a)
        mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
        rotation = u @ mirror @ vt
    return Pose(rotation=rotation, position=true_centre - rotation @ centre)


def path_length(position: Array, step: float = PATH_STEP) -> float:
    """Length (m) of a path (n, 3), counted whenever it has moved `step` (m) on; 0 for one that never does."""
    length, at = 0.0, position[0]
    for point in position[1:]:
        way = float(np.linalg.norm(point - at))
        if way >= step:
            length, at = length + way, point
    return length + (float(np.linalg.norm(position[-1] - at)) if length > 0.0 else 0.0)


def read_tum(path: Path) -> Trajectory:
    """Rows of time (s), position and quaternion x y z w. Raises InputError on a file that is not such a table."""
    try:
        text = path.read_text()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"trajectory {path} can not be read: {error}") from error
    rows = [line.split() for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if not rows or any(len(row) != 8 for row in rows):
        raise InputError(f"trajectory {path} is not in TUM format: time tx ty tz qx qy qz qw, 8 numbers a row")
    try:
        table = np.array([[float(x) for x in row[1:]] for row in rows])
        stamps = np.array([nanoseconds(row[0]) for row in rows], dtype=np.int64)
    except ValueError as error:
        raise InputError(f"trajectory {path} is not in TUM format: {error}") from error
    return Trajectory(stamp_ns=stamps, position=table[:, :3], wxyz=table[:, [6, 3, 4, 5]])


def write_tum(path: Path, trajectory: Trajectory) -> None:
    with path.open("w") as file:
        file.write("# timestamp(s) tx ty tz qx qy qz qw\n")
        for stamp, p, q in zip(trajectory.stamp_ns, trajectory.position, trajectory.wxyz, strict=True):
            seconds, rest = divmod(int(stamp), 1_000_000_000)
            numbers = " ".join(f"{x:.6f}" for x in (*p, *q[1:], q[0]))
            file.write(f"{seconds}.{rest:09d} {numbers}\n")


def nanoseconds(text: str) -> int:
    """Exact reading of decimal seconds: a double holds 1.4e9 s only to 0.2 microseconds."""
    seconds, _, fraction = text.partition(".")
    if "e" in text.lower():
        return round(float(text) * 1e9)
    return int(seconds) * 1_000_000_000 + int((fraction + "0" * 9)[:9])


def _interpolate(truth: Trajectory, stamps: NDArray[np.int64]) -> tuple[list[int], list[Pose]]:
    indices: list[int] = []
    poses: list[Pose] = []
    for i, stamp in enumerate(stamps):
        after = int(np.searchsorted(truth.stamp_ns, stamp, side="left"))
        if after == len(truth) or (after == 0 and truth.stamp_ns[0] != stamp):
            continue
        before = after if truth.stamp_ns[after] == stamp else after - 1
        gap = int(truth.stamp_ns[after] - truth.stamp_ns[before])
        if gap > LONGEST_TRUTH_GAP * 1e9:
            continue
        part = (int(stamp) - int(truth.stamp_ns[before])) / gap if gap else 0.0
        first, second = truth.rotation(before), truth.rotation(after)
        position = (1.0 - part) * truth.position[before] + part * truth.position[after]
        rotation = first @ rotation_exp(part * rotation_log(first.T @ second))
        indices.append(i)
        poses.append(Pose(rotation=rotation, position=position))
    return indices, poses


def same_heading(pose: Pose, truth: Pose) -> Pose:
    """The turn about the vertical and shift that bring `pose` next to `truth`."""
    between = truth.rotation @ pose.rotation.T
    angle = float(np.arctan2(between[1, 0] - between[0, 1], between[0, 0] + between[1, 1]))
    rotation = rotation_z(angle)
    return Pose(rotation=rotation, position=truth.position - rotation @ pose.position)
