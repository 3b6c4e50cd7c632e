"""Whether a calibration can be used, in sentences: what is good, what is doubtful, what rules it out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.guidance import COVER, EYES, Wish
from robot_agent.calibration.inertial_calibration import InertialEstimate
from robot_agent.calibration.rig_batch import RigEstimate

Array = NDArray[np.float64]

FOCAL_SIGMA = 0.002
"""Of the focal length; more is no calibration."""

CENTRE_SIGMA = 3.0
CORNER_SIGMA = 1.0
"""px"""

PATTERN = 0.35
"""Residuals' mean within fields of the picture over their spread: more has a cause that is not noise."""

LEAST_PATTERN = 0.12
"""px; below it a pattern matters to nobody."""

BASELINE_SIGMA = 5e-4
TURN_SIGMA = np.radians(0.1)
LEVER_SIGMA = 3e-3
OFFSET_SIGMA = 3e-4
NOISE_RATIO = 2.5
SCALE_ERROR = 0.01

AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """`faults` rule a calibration out, `doubts` do not."""

    faults: tuple[str, ...]
    doubts: tuple[str, ...]

    @property
    def usable(self) -> bool:
        return not self.faults

    def __str__(self) -> str:
        if self.faults:
            return "not usable: " + "; ".join(self.faults)
        return "usable, but " + "; ".join(self.doubts) if self.doubts else "usable"


def judge_cameras(estimate: RigEstimate, wished: list[Wish]) -> Verdict:
    faults, doubts = [], [wish.advice for wish in wished if not wish.met]
    rig, sigma = estimate.rig, estimate.intrinsics_sigma
    if estimate.sigma > CORNER_SIGMA:
        faults.append(
            f"corners are off by {estimate.sigma:.2f} px: are target and its file the same, is it flat, are the "
            "pictures sharp"
        )
    for eye in range(rig.eyes):
        name = EYES[eye]
        focal = float((sigma[eye, :2] / rig.intrinsics[eye, :2]).max())
        if focal > FOCAL_SIGMA:
            faults.append(f"the {name} eye's focal length is known to {100 * focal:.2f} % only; tilt the target more")
        if float(sigma[eye, 2:4].max()) > CENTRE_SIGMA:
            faults.append(
                f"the {name} eye's centre is known to {sigma[eye, 2:4].max():.1f} px only; tilt the target more"
            )
        pattern = pattern_of(estimate, eye)
        if pattern > max(LEAST_PATTERN, PATTERN * estimate.sigma):
            doubts.append(
                f"the {name} eye's residuals lean by {pattern:.2f} px, each part of the picture its own way: the lens "
                "model does not fit (--model) or the target is not flat"
            )
    if rig.eyes > 1:
        along = np.concatenate([np.zeros(3), rig.eye_from_first[1].position / max(rig.baseline, 1e-9)])
        baseline = float(np.sqrt(along @ estimate.covariance[-6:, -6:] @ along))
        if baseline > BASELINE_SIGMA:
            faults.append(
                f"the baseline is known to {1e3 * baseline:.2f} mm only; show the target to both eyes more often"
            )
    wild = 1.0 - float(estimate.used.mean())
    if wild > 0.02:
        doubts.append(f"{100 * wild:.1f} % of the corners were wild and left out")
    return Verdict(faults=tuple(faults), doubts=tuple(doubts))


def judge_imu(estimate: InertialEstimate) -> Verdict:
    faults, doubts = [], []
    turn = int(np.argmax(estimate.rotation_sigma))
    if estimate.rotation_sigma[turn] > TURN_SIGMA:
        faults.append(
            f"the turn about the camera's {AXES[turn]} axis is known to "
            f"{np.degrees(estimate.rotation_sigma[turn]):.2f} degrees only; turn the rig about its other axes"
        )
    spread, axes = np.linalg.eigh(estimate.position_covariance)
    if np.sqrt(spread[-1]) > LEVER_SIGMA:
        axis = AXES[int(np.argmax(np.abs(axes[:, -1])))]
        faults.append(
            f"the camera's place along the IMU's {axis} axis is known to {1e3 * np.sqrt(spread[-1]):.1f} mm only; "
            f"turn the rig about axes across its {axis} axis, fast"
        )
    if estimate.time_offset_sigma > OFFSET_SIGMA:
        faults.append(
            f"the time offset is known to {1e6 * estimate.time_offset_sigma:.0f} us only; turn the rig faster"
        )
    if abs(estimate.target_scale - 1.0) > max(SCALE_ERROR, 5.0 * estimate.target_scale_sigma):
        faults.append(
            f"by the accelerometer the target is {100.0 * estimate.target_scale:.1f} % of the size its file says: "
            "measure the print, and correct the file"
        )
    for name, errors in (("gyro", estimate.gyro_errors), ("accelerometer", estimate.accel_errors)):
        ratio = float(np.sqrt((errors**2).mean()))
        if ratio > NOISE_RATIO:
            doubts.append(f"the {name} is {ratio:.1f} times as noisy as imu.yaml says")
    return Verdict(faults=tuple(faults), doubts=tuple(doubts))


def pattern_of(estimate: RigEstimate, eye: int) -> float:
    """How far the residuals of a field of the picture lean together (rms over the fields, noise taken off), px."""
    means, counts = field_means(estimate, eye)
    enough = counts >= 20
    if not enough.any():
        return 0.0
    noise = estimate.sigma**2 * 2.0 / counts[enough]
    squared = (means[enough] ** 2).sum(axis=1) - noise
    return float(np.sqrt(max(0.0, float(squared.mean()))))


def field_means(estimate: RigEstimate, eye: int) -> tuple[Array, NDArray[np.int64]]:
    """Mean residual (48, 2) px and number of corners (48,) of each field of an eye's picture."""
    rows = (estimate.table.eye == eye) & estimate.used
    pixels, errors = estimate.table.pixel[rows], estimate.residuals[rows]
    width, height = estimate.rig.sizes[eye]
    down = np.clip((pixels[:, 1] / height * COVER[0]).astype(int), 0, COVER[0] - 1)
    across = np.clip((pixels[:, 0] / width * COVER[1]).astype(int), 0, COVER[1] - 1)
    field = down * COVER[1] + across
    counts = np.bincount(field, minlength=COVER[0] * COVER[1])
    sums = np.stack([np.bincount(field, weights=column, minlength=len(counts)) for column in errors.T], axis=1)
    return sums / np.maximum(counts, 1)[:, None], counts
