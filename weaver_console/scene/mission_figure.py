"""Waypoints and path in the scene: the robot's own mission, and the draft of the page that has not sent it yet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.ground import Ground
from weaver_shared.messages import Waypoint

Array = NDArray[np.float64]

LIFT = 0.03
"""Lines float this far above the ground, m, so that it does not swallow them."""

_SENT = (64, 156, 255)
_REACHED = (110, 122, 138)
_DRAFT = (255, 176, 32)
_SELECTED = (255, 255, 255)
_STEP = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """One mission to draw: `reached` waypoints lie behind, `selected` is marked."""

    kind: str
    waypoints: tuple[Waypoint, ...]
    colour: tuple[int, int, int]
    reached: int = 0
    selected: int | None = None

    @staticmethod
    def sent(waypoints: Sequence[Waypoint], reached: int) -> Course:
        return Course(kind="mission", waypoints=tuple(waypoints), colour=_SENT, reached=reached)

    @staticmethod
    def draft(waypoints: Sequence[Waypoint], selected: int | None) -> Course:
        return Course(kind="draft", waypoints=tuple(waypoints), colour=_DRAFT, selected=selected)


class MissionFigure:
    def __init__(self, scene: Any, name: str, *, acceptance_radius: float) -> None:
        self._scene = scene
        self._name = name
        self._radius = acceptance_radius
        self._nodes: list[Any] = []
        self._shown: object = None

    def update(self, ground: Ground, robot_position: Array | None, mission: Course, draft: Course) -> None:
        """Draw both, the draft only where it differs; `robot_position` (3,), if known, begins the path."""
        courses = [mission] if draft.waypoints == mission.waypoints else [mission, draft]
        start = None if robot_position is None else tuple(np.round(robot_position[:2], 1).tolist())
        wanted = (courses, start, ground.version // 50)
        if wanted == self._shown:
            return
        self._shown = wanted
        for node in self._nodes:
            node.remove()
        self._nodes = []
        for course in courses:
            self._draw(ground, start, course)

    def _draw(self, ground: Ground, start: tuple[float, ...] | None, course: Course) -> None:
        places = [(w.x, w.y) for w in course.waypoints]
        self._nodes.append(self._scene.add_frame(f"{self._name}/{course.kind}", show_axes=False))
        for number, place in enumerate(places):
            chosen = _SELECTED if number == course.selected else course.colour
            shade = _REACHED if number < course.reached else chosen
            self._mark(f"{self._name}/{course.kind}/{number}", ground, place, number + 1, shade)
        ahead = places[course.reached :]
        path = [start, *ahead] if start is not None and ahead else ahead
        if len(path) > 1:
            self._line(f"{self._name}/{course.kind}/path", _draped(ground, path), course.colour)

    def _mark(
        self, name: str, ground: Ground, place: tuple[float, float], number: int, colour: tuple[int, int, int]
    ) -> None:
        height = _height(ground, *place)
        still = {"cast_shadow": False, "receive_shadow": False}
        self._scene.add_cylinder(f"{name}/pole", 0.008, 0.30, color=colour,
                                        position=(*place, height + 0.15), **still)  # fmt: skip
        self._scene.add_icosphere(f"{name}/ball", 0.035, color=colour, subdivisions=2,
                                         position=(*place, height + 0.31), **still)  # fmt: skip
        self._scene.add_label(f"{name}/label", str(number), position=(*place, height + 0.38),
                                      anchor="bottom-center")  # fmt: skip
        angles = np.linspace(0.0, 2.0 * np.pi, 33)
        ring = [(place[0] + self._radius * c, place[1] + self._radius * s)
                for c, s in zip(np.cos(angles), np.sin(angles), strict=True)]  # fmt: skip
        points = np.array([[x, y, _height(ground, x, y, height) + LIFT] for x, y in ring])
        self._line(f"{name}/circle", points, colour)

    def _line(self, name: str, points: Array, colour: tuple[int, int, int]) -> None:
        segments = np.stack([points[:-1], points[1:]], axis=1).astype(np.float32)
        self._scene.add_line_segments(name, segments, colour, thickness=0.012)


def _draped(ground: Ground, places: Sequence[tuple[float, ...]]) -> Array:
    """The path with its height over the ground every few centimetres, (n, 3)."""
    corners = np.array(places)
    points = []
    for begin, end in pairwise(corners):
        count = int(np.clip(np.linalg.norm(end - begin) / _STEP, 1, 200))
        points += [begin + (end - begin) * share for share in np.arange(count) / count]
    points.append(corners[-1])
    heights: list[float] = []
    for x, y in points:
        heights.append(_height(ground, float(x), float(y), heights[-1] if heights else 0.0))
    return np.column_stack([np.array(points), np.array(heights) + LIFT])


def _height(ground: Ground, x: float, y: float, otherwise: float = 0.0) -> float:
    height = ground.height(x, y)
    return height if np.isfinite(height) else otherwise
