"""How a guided calibration of a robot's cameras, or of its cameras and its IMU, is going."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationWish:
    """One thing a good set of views has; `advice` says what to do where it is not met."""

    what: str
    met: bool
    advice: str


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationMotion:
    """How much of one motion the IMU has felt while the target was seen; axes are the IMU's."""

    kind: str  # "turn" about the axis or "push" along it
    axis: str  # "x" (forward), "y" (left) or "z" (up)
    now: float  # root mean square over the last second, in `unit`
    least: float  # of `now`, for that second to count
    unit: str  # "rad/s" or "m/s^2"
    seconds: float  # that counted
    wanted: float  # s
    met: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrationState:
    """Pictures with the corners drawn travel as those of the camera `calibration`, left eye and right eye."""

    phase: str  # "idle", "starting", "looking", "solving", "solved" or "failed"
    part: str  # what is calibrated: "cameras", or "imu" for where it is from them and how late they are
    source: str  # "cameras", or the recording that is looked at
    target: str  # in words
    lenses: str  # those the part "imu" goes by: "robot", or the calibration they were solved in
    calibrations: tuple[str, ...]  # of cameras, the newest first: lenses that the part "imu" can go by
    pictures: int  # looked at
    views: int  # kept of them
    seconds: float  # with the target in view; of the part "imu"
    motions: tuple[CalibrationMotion, ...]  # likewise
    seen: tuple[int, ...]  # corners in the newest picture of each eye
    cover: NDArray[np.int64]  # (eyes, 6, 8) corners seen in each field of the picture, down and across
    wishes: tuple[CalibrationWish, ...]
    advice: str  # what to do next, in words
    step: str  # of the solving, in words
    usable: bool
    verdict: str  # in words, once solved; or why it failed
    results: tuple[str, ...]  # lines with value and unit
    files: tuple[str, ...]  # names, to be asked for as parts
    folder: str  # where they are on the robot
