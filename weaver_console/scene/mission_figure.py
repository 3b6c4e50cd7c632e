"""Waypoints and path in the scene: the robot's own mission, and the draft of the page that has not sent it yet."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.ground import Ground
from weaver_console.scene.lines import NONE, Lines, chained
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


@dataclass(slots=True, kw_only=True)
class _Drawn:
    """The nodes of a course, moved as long as it keeps its number of waypoints: one being dragged stays in hand."""

    root: Any
    poles: Any
    balls: Any
    labels: list[Any]
    circles: Lines
    path: Lines
    corridor: Lines


class MissionFigure:
    """Draws a course anew only when it or the ground under its waypoints changes; the leg ahead follows the robot."""

    def __init__(
        self,
        scene: Any,
        name: str,
        *,
        passing_radius: float,
        goal_radius: float,
        half_width: float,
        on_drag: Callable[[Any], Coroutine[Any, Any, None]] | None = None,
    ) -> None:
        """Circles about waypoints have the radius, in m, within which the robot passes them or has arrived; the feet
        are expected within `half_width` (m) of the path. `on_drag` is told of every waypoint in hand, by viser."""
        self._half_width = half_width
        self._on_drag = on_drag
        self._scene = scene
        self._name = name
        self._passing_radius, self._goal_radius = passing_radius, goal_radius
        self._drawn: dict[str, tuple[object, _Drawn | None]] = {}
        self._leg = Lines(scene, f"{name}/leg", _SENT, thickness=0.012)
        self._leg_corridor = Lines(scene, f"{name}/leg corridor", _SENT, thickness=0.005)
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
        shown, drawn = self._drawn.get(course.kind, (None, None))
        if wanted == shown:
            return
        if drawn is not None and len(drawn.labels) != len(course.waypoints):
            drawn.root.remove()
            drawn = None
        if course.waypoints:
            feet = np.column_stack([np.array(course.places), heights])
            drawn = drawn or self._add(course, feet)
            self._place(drawn, ground, course, feet)
        self._drawn[course.kind] = (wanted, drawn)

    def _add(self, course: Course, feet: Array) -> _Drawn:
        scene, name, count = self._scene, f"{self._name}/{course.kind}", len(feet)
        plain = {"lod": "off", "cast_shadow": False, "receive_shadow": False}
        root = scene.add_frame(name, show_axes=False)
        poles = scene.add_batched_meshes_simple(
            f"{name}/poles", *prism(), upright(count), feet + 0.5 * TOP,
            batched_scales=np.tile(POLE, (count, 1)), batched_colors=course.shades, **plain,
        )  # fmt: skip
        balls = scene.add_batched_meshes_simple(
            f"{name}/balls", *octasphere(), upright(count), feet + TOP,
            batched_scales=np.full(count, BALL_RADIUS), batched_colors=course.shades, **plain,
        )  # fmt: skip
        if self._on_drag is not None:
            balls.on_drag("left")(self._on_drag)
        labels = [
            scene.add_label(f"{name}/label {n}", str(n + 1), position=foot + 1.25 * TOP, anchor="bottom-center")
            for n, foot in enumerate(feet)
        ]
        return _Drawn(
            root=root,
            poles=poles,
            balls=balls,
            labels=labels,
            circles=Lines(scene, f"{name}/circles", course.colour, thickness=0.012),
            path=Lines(scene, f"{name}/path", course.colour, thickness=0.012),
            corridor=Lines(scene, f"{name}/corridor", course.colour, thickness=0.005),
        )

    def _place(self, drawn: _Drawn, ground: Ground, course: Course, feet: Array) -> None:
        shades = course.shades
        drawn.poles.batched_positions, drawn.poles.batched_colors = feet + 0.5 * TOP, shades
        drawn.balls.batched_positions, drawn.balls.batched_colors = feet + TOP, shades
        for label, foot in zip(drawn.labels, feet, strict=True):
            label.position = foot + 1.25 * TOP
        radii = [self._passing_radius] * (len(feet) - 1) + [self._goal_radius]
        circles = [chained(_circle(ground, foot, radius)) for foot, radius in zip(feet, radii, strict=True)]
        drawn.circles.show_in(np.concatenate(circles), np.repeat(shades, len(CIRCLE) - 1, axis=0))
        ahead = course.places[course.reached :]
        path = chained(draped(ground, ahead)) if len(ahead) > 1 else NONE
        drawn.path.show_in(path, np.tile(np.array(course.colour, dtype=np.uint8), (len(path), 1)))
        drawn.corridor.show(self._corridor(ground, ahead))

    def _corridor(self, ground: Ground, places: Sequence[Place]) -> Array:
        """Both borders of the strip in which the feet are expected, (n, 2, 3)."""
        borders = [NONE]
        for begin, end in pairwise(np.array(places)):
            length = float(np.linalg.norm(end - begin))
            if length > 1e-6:
                aside = self._half_width * np.array([begin[1] - end[1], end[0] - begin[0]]) / length
                borders += [chained(draped(ground, [begin + side, end + side])) for side in (aside, -aside)]
        return np.concatenate(borders)

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
        points = draped(ground, [start, ahead[0]]) if wanted is not None and len(start) == 2 else np.zeros((0, 3))
        self._leg.colour(course.colour)
        self._leg.chain(points)
        self._leg_corridor.colour(course.colour)
        self._leg_corridor.show(self._corridor(ground, [start, ahead[0]]) if len(points) and len(start) == 2 else NONE)


def _circle(ground: Ground, foot: Array, radius: float) -> Array:
    places = foot[:2] + radius * CIRCLE
    return np.array([[x, y, _height(ground, x, y, foot[2]) + LIFT] for x, y in places.tolist()])


def draped(ground: Ground, places: Sequence[Place]) -> Array:
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
