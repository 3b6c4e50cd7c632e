"""How a guided calibration of a robot's cameras is going."""

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
class CalibrationState:
    """Pictures with the corners drawn travel as those of the camera `calibration`, left eye and right eye."""

    phase: str  # "idle", "looking", "solving", "solved" or "failed"
    source: str  # "cameras", or the recording that is looked at
    target: str  # in words
    pictures: int  # looked at
    views: int  # kept of them
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
