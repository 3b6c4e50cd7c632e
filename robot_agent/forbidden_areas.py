"""Ground that an operator has forbidden: polygons that the feet of a robot on a straight way must not come into."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.messages import Command, Waypoint

Array = NDArray[np.float64]
Area = tuple[Waypoint, ...]

MOST_AREAS = 50
MOST_CORNERS = 400


def areas_of(command: Command) -> tuple[Area, ...]:
    """The areas in a command: its waypoints are their corners, its name tells how many each has. Raises InputError."""
    try:
        sizes = [int(word) for word in command.name.split()]
    except ValueError:
        raise InputError(f"areas are told by their corners' numbers, as '4 3'; not by {command.name!r:.40}") from None
    if len(sizes) > MOST_AREAS or len(command.waypoints) > MOST_CORNERS:
        raise InputError(f"at most {MOST_AREAS} areas with {MOST_CORNERS} corners can be forbidden")
    if any(size < 3 for size in sizes) or sum(sizes) != len(command.waypoints):
        raise InputError(
            f"an area has three corners or more, and all of them are told: {len(command.waypoints)} came for "
            f"{command.name!r:.40}"
        )
    if not all(isfinite(corner.x) and isfinite(corner.y) for corner in command.waypoints):
        raise InputError("the corners of an area are places: x and y must be finite numbers in metres")
    ends = np.cumsum(sizes)
    return tuple(command.waypoints[end - size : end] for end, size in zip(ends.tolist(), sizes, strict=True))


def hit(areas: Sequence[Area], begin: tuple[float, float], end: tuple[float, float], half_width: float) -> int | None:
    """Number (from 1) of the first area that a strip of this half width (m) about a straight leg comes into.

    A robot that stands in an area already may leave it.
    """
    for number, area in enumerate(areas, start=1):
        corners = np.array([(corner.x, corner.y) for corner in area])
        start = np.array(begin)
        if _distance(corners, start, start) < half_width:
            start = np.array(end)  # from where it stands it may go anywhere outside
        if _distance(corners, start, np.array(end)) < half_width:
            return number
    return None


def _distance(corners: Array, begin: Array, end: Array) -> float:
    """Between a polygon (n, 2) and a segment, m; 0 where they overlap."""
    following = np.roll(corners, -1, axis=0)
    if _inside(corners, following, begin) or _crossed(corners, following, begin, end):
        return 0.0
    to_edges = min(_to_segments(place, corners, following) for place in (begin, end))
    to_way = min(_to_segments(corner, begin[None], end[None]) for corner in corners)
    return min(to_edges, to_way)


def _inside(corners: Array, following: Array, place: Array) -> bool:
    """Whether a ray along x leaves the polygon an odd number of times."""
    spans = (corners[:, 1] > place[1]) != (following[:, 1] > place[1])
    rise = np.where(spans, following[:, 1] - corners[:, 1], 1.0)
    x = corners[:, 0] + (place[1] - corners[:, 1]) / rise * (following[:, 0] - corners[:, 0])
    return bool(np.count_nonzero(spans & (x > place[0])) % 2)


def _crossed(corners: Array, following: Array, begin: Array, end: Array) -> bool:
    sides = _side(begin, end, corners) * _side(begin, end, following)
    others = _side(corners, following, begin) * _side(corners, following, end)
    return bool(((sides < 0.0) & (others < 0.0)).any())


def _side(begin: Array, end: Array, place: Array) -> Array:
    way, to = end - begin, place - begin
    side: Array = way[..., 0] * to[..., 1] - way[..., 1] * to[..., 0]
    return side


def _to_segments(place: Array, begin: Array, end: Array) -> float:
    """Least distance of a place (2,) from segments (n, 2), m."""
    along = end - begin
    length = np.maximum((along**2).sum(axis=1), 1e-12)
    share = np.clip(((place - begin) * along).sum(axis=1) / length, 0.0, 1.0)
    return float(np.linalg.norm(begin + share[:, None] * along - place, axis=1).min())
