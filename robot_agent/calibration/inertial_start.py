"""A start for camera and IMU: the turn and the delay under which both tell of the same rotation."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.messages import ImuBatch
from weaver_shared.transforms import Pose, rotation_log

Array = NDArray[np.float64]

LONGEST_GAP = 0.3
"""Between pictures whose poses are compared, s."""

LARGEST_OFFSET = 0.25
"""Between the clocks, s."""

COARSE, FINE = 0.004, 0.0005
"""Steps of the search, s."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InertialStart:
    imu_from_camera: Array  # rotation (3, 3)
    time_offset: float  # s, added to a picture's stamp to get the IMU's time
    gyro_bias: Array  # (3,) rad/s
    misfit: float  # rad/s rms between the two


def align(stamps: Array, camera_from_target: list[Pose], times: Array, rates: Array) -> InertialStart:
    """Picture stamps (n,) s and poses, gyro samples (m,) s and (m, 3) rad/s, both from the same origin."""
    gaps = np.diff(stamps)
    usable = (gaps > 1e-4) & (gaps < LONGEST_GAP)
    if usable.sum() < 20:
        raise InputError(
            f"only {int(usable.sum())} pictures with the target follow each other within {LONGEST_GAP} s; the "
            "camera-IMU part needs at least 20, at 4 Hz or more"
        )
    turns = np.array([rotation_log(a.rotation @ b.rotation.T) for a, b in pairwise(camera_from_target)])
    seen = turns[usable] / gaps[usable, None]
    begins, ends = stamps[:-1][usable], stamps[1:][usable]
    angle = np.concatenate(
        [np.zeros((1, 3)), np.cumsum(0.5 * (rates[1:] + rates[:-1]) * np.diff(times)[:, None], axis=0)]
    )

    def at(offset: float) -> tuple[float, Array, Array]:
        felt = (_between(times, angle, ends + offset) - _between(times, angle, begins + offset)) / (ends - begins)[
            :, None
        ]
        known = (begins + offset >= times[0]) & (ends + offset <= times[-1])
        if known.sum() < max(10, 0.5 * len(known)):
            return np.inf, np.eye(3), np.zeros(3)
        rotation, bias = _turn_between(seen[known], felt[known])
        return float(np.sqrt(np.mean((felt[known] - seen[known] @ rotation.T - bias) ** 2))), rotation, bias

    best = min(np.arange(-LARGEST_OFFSET, LARGEST_OFFSET + COARSE, COARSE), key=lambda offset: at(offset)[0])
    best = min(best + np.arange(-COARSE, COARSE + FINE, FINE), key=lambda offset: at(offset)[0])
    misfit, rotation, bias = at(float(best))
    if not np.isfinite(misfit):
        raise InputError("pictures and IMU samples have no time in common: are they of one recording and one clock?")
    return InertialStart(imu_from_camera=rotation, time_offset=float(best), gyro_bias=bias, misfit=misfit)


def _turn_between(seen: Array, felt: Array) -> tuple[Array, Array]:
    """Rotation and bias with felt = rotation seen + bias in least squares (Kabsch 1976); vectors (n, 3)."""
    centred, centred_felt = seen - seen.mean(axis=0), felt - felt.mean(axis=0)
    u, _, vt = np.linalg.svd(centred_felt.T @ centred)
    rotation = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    return rotation, felt.mean(axis=0) - rotation @ seen.mean(axis=0)


def _between(times: Array, values: Array, wanted: Array) -> Array:
    return np.stack([np.interp(wanted, times, column) for column in values.T], axis=1)


def seconds_of(imu: ImuBatch, origin_ns: int) -> Array:
    return np.asarray((imu.stamp_ns - origin_ns) * 1e-9)
