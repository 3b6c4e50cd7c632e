"""A measured line between two places of the ground, with its length, rise and slope."""

from __future__ import annotations

from math import atan2, degrees, hypot
from typing import Any

import numpy as np

from weaver_console.scene.lines import NONE, Lines
from weaver_shared.messages import Waypoint

LIFT = 0.02
_COLOUR = (0, 229, 255)


class MeasureFigure:
    def __init__(self, scene: Any, name: str) -> None:
        self._line = Lines(scene, f"{name}/line", _COLOUR, thickness=0.012)
        self._label = scene.add_label(f"{name}/label", "", visible=False, anchor="bottom-center")
        self._shown: object = None

    def update(self, ground: Any, places: tuple[Waypoint, ...]) -> None:
        """Up to two places, in world."""
        heights = [ground.height(place.x, place.y) for place in places]
        wanted = (places, tuple(round(height, 3) for height in heights))
        if repr(wanted) == self._shown:
            return
        self._shown = repr(wanted)
        points = np.array(
            [[p.x, p.y, (z if np.isfinite(z) else 0.0) + LIFT] for p, z in zip(places, heights, strict=True)]
        )
        if len(points) == 1:
            points = np.stack([points[0], points[0] + [0.0, 0.0, 0.25]])
        self._line.show(points[None] if len(points) == 2 else NONE)
        self._label.visible = len(places) == 2
        if len(places) == 2:
            self._label.position = points.mean(axis=0)
            self._label.text = described(places, heights)


def described(places: tuple[Waypoint, ...], heights: list[float]) -> str:
    """ "1.20 m, 0.05 m up, 2°": of the way from the first place to the second, seen from above."""
    length = hypot(places[1].x - places[0].x, places[1].y - places[0].y)
    rise = heights[1] - heights[0]
    if not np.isfinite(rise):
        return f"{length:.2f} m"
    return (
        f"{length:.2f} m, {abs(rise):.2f} m {'up' if rise >= 0 else 'down'}, {degrees(atan2(abs(rise), length)):.0f}°"
    )
