"""Centre of mass, where it weighs on the ground, and how far that is from the edge of the support polygon."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.lines import NONE, Lines
from weaver_console.scene.node_values import place

Array = NDArray[np.float64]

RADIUS = 0.018
_MASS = (250, 204, 21)
_STABLE, _UNSTABLE = (52, 199, 129), (239, 83, 80)


class BalanceFigure:
    def __init__(self, scene: Any, name: str) -> None:
        still = {"cast_shadow": False, "receive_shadow": False}
        self._mass = scene.add_icosphere(f"{name}/mass", RADIUS, _MASS, subdivisions=1, visible=False, **still)
        self._plumb = Lines(scene, f"{name}/plumb", _MASS, thickness=0.004)
        self._margin = Lines(scene, f"{name}/margin", _STABLE, thickness=0.008)
        self._label = scene.add_label(f"{name}/label", "", visible=False, font_screen_scale=0.8, anchor="bottom-left")

    def update(self, mass: Array, hull: Array, margin: float) -> None:
        """`mass` (3,) is its centre and `hull` (n + 1, 3) the closed support polygon, or empty, both in world; `margin`
        as the robot tells it, m."""
        place(self._mass, mass)
        self._mass.visible = True
        shown = len(hull) > 0 and np.isfinite(margin)
        self._label.visible = shown
        if not shown:
            self._plumb.show(NONE)
            self._margin.show(NONE)
            return
        foot = np.array([mass[0], mass[1], hull[:, 2].mean()])
        edge = nearest_on(hull, foot)
        self._plumb.chain(np.array([mass, foot]))
        self._margin.chain(np.array([foot, edge]))
        self._margin.colour(_STABLE if margin > 0.0 else _UNSTABLE)
        place(self._label, edge)
        text = f"{margin:.2f} m"
        if self._label.text != text:
            self._label.text = text


def nearest_on(chain: Array, place: Array) -> Array:
    """The point (3,) of a line through points (n, 3) that is nearest to a place, seen from above."""
    begin, along = chain[:-1], np.diff(chain, axis=0)
    length = np.maximum((along[:, :2] ** 2).sum(axis=1), 1e-12)
    share = np.clip(((place[:2] - begin[:, :2]) * along[:, :2]).sum(axis=1) / length, 0.0, 1.0)
    points = begin + share[:, None] * along
    return np.asarray(points[np.argmin(np.linalg.norm(points[:, :2] - place[:2], axis=1))])
