"""What the calibrator does with either calibration: show it pictures and samples, tell how it goes, solve and save."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from weaver_shared.messages import CalibrationState, ImuBatch, StereoFrame


@dataclass(frozen=True, slots=True, kw_only=True)
class Solved:
    """What came of it, in words."""

    verdict: str
    usable: bool = False
    lines: tuple[str, ...] = ()  # the main figures
    files: tuple[str, ...] = ()  # names, with the folder they are in; none where it failed


class GuidedSession(Protocol):
    @property
    def look_every_ns(self) -> int:
        """Of the pictures' own time."""
        ...

    def look(self, frame: StereoFrame) -> None:
        """Look for the target. Raises InputError."""
        ...

    def drawn(self, frame: StereoFrame) -> bytes:
        """Both eyes with the corners that were found, as JPEG."""
        ...

    def feel(self, samples: ImuBatch) -> None: ...

    def filled(self, state: CalibrationState) -> CalibrationState:
        """The state with all that this calibration knows of itself."""
        ...

    def solve(self, model: str, folder: Path, tell: Callable[[str], None]) -> Solved:
        """Solve and write files into `folder`, on a thread of its own. Raises InputError or OSError."""
        ...
