"""What the calibrator does with either calibration: show it pictures and samples, tell how it goes, solve and save."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from robot_agent.calibration.guidance import Wish
from robot_agent.calibration.sightings import Sighting
from weaver_shared.messages import CalibrationState, CalibrationWish, ImuBatch, StereoFrame


@dataclass(frozen=True, slots=True, kw_only=True)
class Solved:
    """What came of it, in words."""

    verdict: str
    usable: bool = False
    lines: tuple[str, ...] = ()  # the main figures
    files: tuple[str, ...] = ()  # names, with the folder they are in; none where it failed


class Guide(Protocol):
    """What leads through either calibration."""

    @property
    def pictures(self) -> int: ...

    @property
    def views(self) -> int: ...

    @property
    def sightings(self) -> tuple[Sighting | None, ...]: ...

    def wishes(self) -> Sequence[Wish]: ...

    def advice(self) -> str: ...


def guided_state(state: CalibrationState, guide: Guide) -> CalibrationState:
    """The state with what every guide knows."""
    return replace(
        state,
        pictures=guide.pictures,
        views=guide.views,
        seen=tuple(len(s) if s else 0 for s in guide.sightings),
        wishes=tuple(CalibrationWish(what=w.what, met=bool(w.met), advice=w.advice) for w in guide.wishes()),
        advice=guide.advice(),
    )


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
