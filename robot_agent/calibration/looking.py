"""From pictures to sightings."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

from robot_agent.calibration.chessboard_detector import ChessboardDetector
from robot_agent.calibration.grid_detector import GridDetector
from robot_agent.calibration.pictures import Pictures
from robot_agent.calibration.sightings import Picture, Session, Sighting, View
from robot_agent.calibration.target import AprilGrid, Target
from weaver_shared.errors import InputError

LEAST_CORNERS = 16
"""Of a sighting that is worth keeping, in the better eye; fewer say little."""


class Detector(Protocol):
    def detect(self, picture: Picture) -> Sighting | None: ...


def detector_of(target: Target) -> Detector:
    return GridDetector(target) if isinstance(target, AprilGrid) else ChessboardDetector(target)


def called(target: Target) -> str:
    return f"an {target}" if isinstance(target, AprilGrid) else f"a {target}"


def sized(picture: Picture, size: tuple[int, int], told_by: str) -> Picture:
    """The picture itself. Raises InputError where it is not of the `size` (width, height) that `told_by` tells."""
    height, width = picture.shape
    if (width, height) != size:
        raise InputError(f"the pictures are {width} x {height} px, {told_by} says {size[0]} x {size[1]}")
    return picture


def look(source: Pictures, target: Target, progress: Callable[[int], None] = lambda _: None) -> Session:
    """Every view with the target in at least one eye. Raises InputError where it is in none."""
    views = tuple(view for view in _views(source, target, progress) if view.seen > 0)
    if not views:
        raise InputError(
            f"no target found in any of the {len(source)} pictures of {source.folder}: looked for {called(target)}"
        )
    return Session(views=views, sizes=source.sizes(), pictures=len(source))


def _views(source: Pictures, target: Target, progress: Callable[[int], None]) -> Iterator[View]:
    detector = detector_of(target)
    for stamp, name, pictures in source:
        eyes = tuple(None if picture is None else detector.detect(picture) for picture in pictures)
        progress(1)
        yield View(stamp_ns=stamp, eyes=eyes, name=name)
