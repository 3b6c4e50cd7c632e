"""Forbidden ground in the scene: its borders, low fences in red, as the page's operator has drawn them."""

from __future__ import annotations

from typing import Any

import numpy as np

from weaver_console.scene.ground import Ground
from weaver_console.scene.lines import NONE, Lines, chained
from weaver_console.scene.mission_figure import draped
from weaver_shared.messages import Waypoint

RAILS = (0.0, 0.08, 0.16)
"""m over the ground at which each border has a rail."""

_COLOUR = (226, 62, 62)


class AreaFigure:
    def __init__(self, scene: Any, name: str) -> None:
        self._lines = Lines(scene, f"{name}/fences", _COLOUR, thickness=0.012)
        self._shown: tuple[tuple[Waypoint, ...], ...] = ()
        self._ground_version = -1

    def update(self, ground: Ground, areas: tuple[tuple[Waypoint, ...], ...]) -> None:
        if areas == self._shown and (not areas or ground.version == self._ground_version):
            return
        self._shown, self._ground_version = areas, ground.version
        fences = [NONE]
        for area in areas:
            corners = [(corner.x, corner.y) for corner in area]
            border = draped(ground, [*corners, corners[0]])
            fences += [chained(border + np.array([0.0, 0.0, rail])) for rail in RAILS]
        self._lines.show(np.concatenate(fences))
