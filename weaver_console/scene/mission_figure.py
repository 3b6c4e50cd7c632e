"""Waypoints and path in the scene: the robot's own mission, and the draft of the page that has not sent it yet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.ground import Ground
from weaver_console.scene.lines import Lines, chained
from weaver_console.scene.shapes import octasphere, prism, upright
from weaver_shared.messages import Waypoint

Array = NDArray[np.float64]
Place = tuple[float, float]

LIFT = 0.03
"""Lines float this far above the ground, m, so that it does not swallow them."""

POLE = (0.014, 0.014, 0.30)
TOP = np.array([0.0, 0.0, POLE[2]])
BALL_RADIUS = 0.035
STEP = 0.1
LEG_STEP = 0.05
CIRCLE = np.stack([np.cos(np.linspace(0.0, 2.0 * np.pi, 33)), np.sin(np.linspace(0.0, 2.0 * np.pi, 33))], axis=1)

_SENT = (64, 156, 255)
_REACHED = (110, 122, 138)
_DRAFT = (255, 176, 32)
_SELECTED = (255, 255, 255)


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

    @property
    def places(self) -> list[Place]:
        return [(waypoint.x, waypoint.y) for waypoint in self.waypoints]

    @property
    def shades(self) -> NDArray[np.uint8]:
        """A colour for each waypoint, (n, 3)."""
        chosen = [_SELECTED if n == self.selected else self.colour for n in range(len(self.waypoints))]
        return np.array([_REACHED if n < self.reached else c for n, c in enumerate(chosen)], dtype=np.uint8)


class MissionFigure:
    """Draws a course anew only when it or the ground under its waypoints changes; the leg ahead follows the robot."""

    def __init__(self, scene: Any, name: str, *, passing_radius: float, goal_radius: float) -> None:
        """Circles about waypoints have the radius, in m, within which the robot passes them or has arrived."""
        self._scene = scene
        self._name = name
        self._passing_radius, self._goal_radius = passing_radius, goal_radius
        self._drawn: dict[str, tuple[object, Any]] = {}
        self._leg = Lines(scene, f"{name}/leg", _SENT, thickness=0.012)
        self._leg_shown: object = None

    def update(self, ground: Ground, robot_position: Array | None, mission: Course, draft: Course) -> None:
        """Draw both, the draft only where it differs; `robot_position` (3,), if known, begins the path."""
        if draft.waypoints == mission.waypoints:
            draft = Course.draft((), None)
        for course in (mission, draft):
            self._update(ground, course)
        self._update_leg(ground, robot_position, draft if draft.waypoints else mission)

    def _update(self, ground: Ground, course: Course) -> None:
        heights = [_height(ground, *place) for place in course.places]
        wanted = (course, [round(height / 0.02) for height in heights])
        shown, node = self._drawn.get(course.kind, (None, None))
        if wanted == shown:
            return
        if node is not None:
            node.remove()
        self._drawn[course.kind] = (wanted, self._draw(ground, course, heights) if course.waypoints else None)

    def _draw(self, ground: Ground, course: Course, heights: list[float]) -> Any:
        name = f"{self._name}/{course.kind}"
        root = self._scene.add_frame(name, show_axes=False)
        feet = np.column_stack([np.array(course.places), heights])
        self._add_marks(name, feet, course.shades)
        radii = [self._passing_radius] * (len(feet) - 1) + [self._goal_radius]
        circles = [chained(_circle(ground, foot, radius)) for foot, radius in zip(feet, radii, strict=True)]
        self._add_lines(f"{name}/circles", np.concatenate(circles), np.repeat(course.shades, len(CIRCLE) - 1, axis=0))
        ahead = course.places[course.reached :]
        if len(ahead) > 1:
            path = chained(_draped(ground, ahead))
            self._add_lines(f"{name}/path", path, np.tile(np.array(course.colour, dtype=np.uint8), (len(path), 1)))
        return root

    def _add_marks(self, name: str, feet: Array, shades: NDArray[np.uint8]) -> None:
        count, plain = len(feet), {"lod": "off", "cast_shadow": False, "receive_shadow": False}
        self._scene.add_batched_meshes_simple(
            f"{name}/poles", *prism(), upright(count), feet + 0.5 * TOP,
            batched_scales=np.tile(POLE, (count, 1)), batched_colors=shades, **plain,
        )  # fmt: skip
        self._scene.add_batched_meshes_simple(
            f"{name}/balls", *octasphere(), upright(count), feet + TOP,
            batched_scales=np.full(count, BALL_RADIUS), batched_colors=shades, **plain,
        )  # fmt: skip
        for number, foot in enumerate(feet):
            self._scene.add_label(
                f"{name}/label {number}", str(number + 1), position=foot + 1.25 * TOP, anchor="bottom-center"
            )

    def _add_lines(self, name: str, segments: Array, colours: NDArray[np.uint8]) -> None:
        both_ends = np.repeat(colours[:, None], 2, axis=1)
        self._scene.add_line_segments(name, segments.astype(np.float32), both_ends, thickness=0.012)

    def _update_leg(self, ground: Ground, robot_position: Array | None, course: Course) -> None:
        """The line from the robot to the waypoint it goes to next, anew every few centimetres of its way."""
        ahead = course.places[course.reached :]
        if robot_position is None or not ahead:
            wanted = None
        else:
            wanted = (tuple(np.round(robot_position[:2] / LEG_STEP).tolist()), ahead[0], course.kind)
        if wanted == self._leg_shown:
            return
        self._leg_shown = wanted
        start = () if robot_position is None else (float(robot_position[0]), float(robot_position[1]))
        points = _draped(ground, [start, ahead[0]]) if wanted is not None and len(start) == 2 else np.zeros((0, 3))
        self._leg.colour(course.colour)
        self._leg.chain(points)


def _circle(ground: Ground, foot: Array, radius: float) -> Array:
    places = foot[:2] + radius * CIRCLE
    return np.array([[x, y, _height(ground, x, y, foot[2]) + LIFT] for x, y in places.tolist()])


def _draped(ground: Ground, places: Sequence[Place]) -> Array:
    """The path with its height over the ground every few centimetres, (n, 3)."""
    corners = np.array(places)
    points = []
    for begin, end in pairwise(corners):
        count = int(np.clip(np.linalg.norm(end - begin) / STEP, 1, 200))
        points += [begin + (end - begin) * share for share in np.arange(count) / count]
    points.append(corners[-1])
    heights: list[float] = []
    for x, y in points:
        heights.append(_height(ground, float(x), float(y), heights[-1] if heights else 0.0))
    return np.column_stack([np.array(points), np.array(heights) + LIFT])


def _height(ground: Ground, x: float, y: float, otherwise: float = 0.0) -> float:
    height = ground.height(x, y)
    return height if np.isfinite(height) else otherwise
