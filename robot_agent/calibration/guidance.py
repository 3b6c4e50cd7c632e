"""Which views a recording still lacks: how much of the picture was covered, from which sides, how near and far."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.sightings import Session
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

COVER = (6, 8)
"""Fields of the picture, down and across."""

COVERED = 4
"""Corners that make a field covered."""

ENOUGH_COVER = 0.8
ENOUGH_VIEWS = 20
TILT = np.radians(15.0)
ENOUGH_TILTED = 3
DISTANCES = 1.4
"""Farthest over nearest view."""

EYES = ("left", "right")
AREAS = (("upper left", "top", "upper right"), ("left", "middle", "right"), ("lower left", "bottom", "lower right"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Wish:
    """One thing a good recording has; `advice` says what to do about it where it is not so."""

    what: str
    met: bool
    advice: str


def cover_of(session: Session, eye: int) -> NDArray[np.int64]:
    """Corners seen in each field of an eye's picture (6, 8)."""
    width, height = session.sizes[eye]
    sightings = [sighting for view in session.views if (sighting := view.eyes[eye]) is not None]
    pixels = np.concatenate([np.empty((0, 2)), *(sighting.pixels for sighting in sightings)])
    rows = np.clip((pixels[:, 1] / height * COVER[0]).astype(int), 0, COVER[0] - 1)
    columns = np.clip((pixels[:, 0] / width * COVER[1]).astype(int), 0, COVER[1] - 1)
    fields = np.zeros(COVER, dtype=np.int64)
    np.add.at(fields, (rows, columns), 1)
    return fields


def wishes(session: Session, first_from_target: Sequence[Pose]) -> list[Wish]:
    """In the order in which a person would go about them."""
    count = len(first_from_target)
    found = [
        Wish(
            what=f"{count} views",
            met=count >= ENOUGH_VIEWS,
            advice=f"take {max(0, ENOUGH_VIEWS - count)} more pictures, each from elsewhere",
        )
    ]
    found += [_cover_wish(session, eye) for eye in range(session.eyes)]
    found += _tilt_wishes(first_from_target)
    distances = [float(pose.position[2]) for pose in first_from_target]
    ratio = max(distances) / min(distances) if distances else 1.0
    found.append(
        Wish(
            what=f"distances {min(distances, default=0.0):.2f} to {max(distances, default=0.0):.2f} m",
            met=ratio >= DISTANCES,
            advice=f"go nearer and farther: the farthest view should be {DISTANCES} times as far as the nearest",
        )
    )
    rolls = np.array([np.arctan2(pose.rotation[1, 0], pose.rotation[0, 0]) for pose in first_from_target])
    spread = _angular_spread(rolls)
    found.append(
        Wish(
            what=f"turned about the line of sight by {np.degrees(spread):.0f} degrees",
            met=spread > np.radians(30.0),
            advice="turn the camera (or the target) about its line of sight by 45 degrees or more",
        )
    )
    return found


def _cover_wish(session: Session, eye: int) -> Wish:
    covered = cover_of(session, eye) >= COVERED
    share = float(covered.mean())
    name = EYES[eye] if session.eyes > 1 else "camera's"
    empty = [AREAS[row][column] for row in range(3) for column in range(3) if _part(covered, row, column).mean() < 0.6]
    return Wish(
        what=f"{100 * share:.0f} % of the {name} picture covered",
        met=share >= ENOUGH_COVER,
        advice=f"bring the target to the {', '.join(empty) or 'edges'} of the {name} picture",
    )


def _part(covered: NDArray[np.bool_], row: int, column: int) -> NDArray[np.bool_]:
    rows = np.array_split(np.arange(COVER[0]), 3)[row]
    columns = np.array_split(np.arange(COVER[1]), 3)[column]
    return covered[np.ix_(rows, columns)]


def _tilt_wishes(first_from_target: Sequence[Pose]) -> list[Wish]:
    """The target's normal as the camera sees it leans to all four sides often enough."""
    normals = np.array([pose.rotation[:, 2] for pose in first_from_target]).reshape(-1, 3)
    sides = {
        "its left edge nearer": normals[:, 0] > np.sin(TILT),
        "its right edge nearer": normals[:, 0] < -np.sin(TILT),
        "its upper edge nearer": normals[:, 1] > np.sin(TILT),
        "its lower edge nearer": normals[:, 1] < -np.sin(TILT),
    }
    return [
        Wish(
            what=f"{int(tilted.sum())} views with the target tilted, {side}",
            met=int(tilted.sum()) >= ENOUGH_TILTED,
            advice=f"tilt the target by 20 to 40 degrees, {side}, in {ENOUGH_TILTED} views or more",
        )
        for side, tilted in sides.items()
    ]


def _angular_spread(angles: Array) -> float:
    """Of the shortest arc that holds all angles (rad)."""
    if len(angles) < 2:
        return 0.0
    ordered = np.sort(angles)
    gaps = np.append(np.diff(ordered), ordered[0] + 2.0 * np.pi - ordered[-1])
    return float(2.0 * np.pi - gaps.max())
