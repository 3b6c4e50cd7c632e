"""How a guided calibration is ordered in one line, and the names of files that may stand in it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from robot_agent.calibration.target import Target
from robot_agent.calibration.target_words import target_of
from weaver_shared.errors import InputError

RECORDING = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,100}\.mcap")
FOLDER = re.compile(r"[A-Za-z0-9_-]{1,80}")
FILE = re.compile(
    rf"{FOLDER.pattern}/(camchain\.yaml|camchain-imucam\.yaml|imu\.yaml|target\.yaml|camera\.toml|report\.html|report\.md)"
)

Part = Literal["cameras", "imu"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionOrder:
    """Read from `[imu] TARGET [with FOLDER] [from RECORDING]`."""

    part: Part
    target: Target
    lenses: str  # folder of the calibration whose lenses the part "imu" goes by; empty for the robot's description
    recording: str  # empty for the robot's cameras, now

    @staticmethod
    def of(text: str) -> SessionOrder:
        """Raises InputError that says what is wrong."""
        rest, _, recording = text.partition(" from ")
        rest, _, lenses = rest.partition(" with ")
        part: Part = "imu" if rest.startswith("imu ") else "cameras"
        target = target_of(rest.removeprefix("imu "))
        if recording and not RECORDING.fullmatch(recording):
            raise InputError(f"{recording!r:.60} is not the name of a recording")
        if lenses and not FOLDER.fullmatch(lenses):
            raise InputError(f"{lenses!r:.60} is not the name of a calibration")
        return SessionOrder(part=part, target=target, lenses=lenses, recording=recording)
