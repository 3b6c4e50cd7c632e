"""Keeps a robot out of polygons: whether a way comes into one, how far places are from it, how fast it may near it.

All that walks is bound by these: straight missions are refused by `hit`, ways that are found lead around `depths`, and
what a hand or a cruise steers is slowed by `AreaFence`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.navigation import FenceConfig
from weaver_shared.messages import Waypoint

Array = NDArray[np.float64]
Area = tuple[Waypoint, ...]


def hit(areas: Sequence[Area], begin: tuple[float, float], end: tuple[float, float], half_width: float) -> int | None:
    """Number (from 1) of the first area that a strip of this half width (m) about a straight leg comes into.

    A robot that stands in an area already may leave it.
    """
    low, high = np.minimum(begin, end) - half_width, np.maximum(begin, end) + half_width
    for number, area in enumerate(areas, start=1):
        corners = corners_of(area)
        if (corners.max(axis=0) < low).any() or (corners.min(axis=0) > high).any():
            continue
        start = np.array(begin)
        if _distance(corners, start, start) < half_width:
            start = np.array(end)  # from where it stands it may go anywhere outside
        if _distance(corners, start, np.array(end)) < half_width:
            return number
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Fenced:
    velocity: Array  # (3,) as asked, or with its translation slowed
    area: int  # number from 1 of the area that slows it most, 0 for none
    halted: bool  # the translation is stopped


class AreaFence:
    """Slows a robot that is steered towards an area so that it stops before its feet would come into it.

    The speed towards each edge falls with the distance left, which for a robot that obeys late still never reaches 0.
    Whoever stands too near already, or inside, may go wherever the nearest edge does not come nearer: out, or along it.
    """

    def __init__(self, radius: float, half_width: float, config: FenceConfig | None = None) -> None:
        """`radius` (m) is that of the circle about the feet: steered, the robot may turn anywhere. Only nearer than
        `half_width` must its way lead strictly out."""
        self._config = config or FenceConfig()
        self._radius = radius + self._config.stop_short
        self._half_width = half_width

    def limit(self, areas: Sequence[Area], velocity: Array, place: Array, heading: Array) -> Fenced:
        """Body velocity (3,) in m/s and rad/s of a robot at world `place` (2,) whose x axis points along `heading`
        (2,), of length 1."""
        ahead, aside = velocity[:2]
        motion = ahead * heading + aside * np.array([-heading[1], heading[0]])
        speed = float(np.hypot(*motion))
        share, slowed_by = 1.0, 0
        if speed > 0.0:
            for number, area in enumerate(areas, start=1):
                allowed = self._share(corners_of(area), motion, speed, place)
                if allowed < share:
                    share, slowed_by = allowed, number
        halted = slowed_by > 0 and share * speed < self._config.slowest
        if halted:
            share = 0.0
        return Fenced(velocity=velocity * [share, share, 1.0], area=slowed_by, halted=halted)

    def _share(self, corners: Array, motion: Array, speed: float, place: Array) -> float:
        """Of the motion that one area leaves."""
        following = np.roll(corners, -1, axis=0)
        away, distance = _from_segments(place, corners, following)
        inside = _inside(corners, following, place)
        nearest = int(np.argmin(distance))
        outwards = (-away if inside else away) / np.maximum(distance, 1e-9)[:, None]
        leaving = outwards @ motion
        if inside or distance[nearest] < self._radius:
            along = self._config.along if not inside and distance[nearest] > self._half_width else 0.01
            return 1.0 if leaving[nearest] >= -along * speed else 0.0
        allowed = self._config.approach * (distance - self._radius)
        nearing = -leaving > allowed
        return float((allowed[nearing] / -leaving[nearing]).min()) if nearing.any() else 1.0


def depths(area: Area, places: Array) -> Array:
    """Distances (n,) in m of places (n, 2) from an area, negative inside it."""
    corners = corners_of(area)
    following = np.roll(corners, -1, axis=0)
    nearest = np.full(len(places), np.inf)
    inside = np.zeros(len(places), dtype=np.bool_)
    for begin, end in zip(corners, following, strict=True):
        nearest = np.minimum(nearest, _from_segments(places, begin, end)[1])
        spans = (begin[1] > places[:, 1]) != (end[1] > places[:, 1])
        rise = end[1] - begin[1] or 1.0
        inside ^= spans & (begin[0] + (places[:, 1] - begin[1]) / rise * (end[0] - begin[0]) > places[:, 0])
    return np.where(inside, -nearest, nearest)


def corners_of(area: Area) -> Array:
    """(n, 2) in world, m."""
    return np.array([(corner.x, corner.y) for corner in area])


def _distance(corners: Array, begin: Array, end: Array) -> float:
    """Between a polygon (n, 2) and a segment, m; 0 where they overlap."""
    following = np.roll(corners, -1, axis=0)
    if _inside(corners, following, begin) or _crossed(corners, following, begin, end):
        return 0.0
    to_edges = min(_to_segments(place, corners, following) for place in (begin, end))
    away, _ = _from_segments(corners, begin, end)
    return min(to_edges, float(np.hypot(*away.T).min()))


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
    away, _ = _from_segments(place, begin, end)
    return float(np.hypot(*away.T).min())


def _from_segments(places: Array, begin: Array, end: Array) -> tuple[Array, Array]:
    """What leads from the nearest points of segments to places, and its lengths in m; shapes (..., 2) that fit."""
    along = end - begin
    length = np.maximum((along**2).sum(axis=-1), 1e-12)
    share = np.clip(((places - begin) * along).sum(axis=-1) / length, 0.0, 1.0)
    away: Array = places - begin - share[..., None] * along
    return away, np.hypot(away[..., 0], away[..., 1])
