"""Where each foot can go: found by pushing it along eight bearings until the solver fails (facts 3.4)."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.leg import TOLERANCE, Leg

Array = NDArray[np.float64]
Radii = dict[int, float]
"""Radius (m) by bearing (deg), 0 to 360."""

BEARINGS = tuple(range(0, 361, 45))
STEP = 0.002
LARGEST_RADIUS = 1.0
LAYERS = 10


@dataclass(frozen=True, slots=True)
class Workspace:
    """Radii by height (m) over the stance, lowest first; one layer for even ground."""

    layers: tuple[tuple[float, Radii], ...]

    def at(self, height: float) -> Radii:
        """Between the layers about `height`; empty outside."""
        heights = [layer for layer, _ in self.layers]
        if not heights[0] <= height <= heights[-1]:
            return {}
        if len(self.layers) == 1:
            return self.layers[0][1]
        upper = min(bisect_right(heights, height), len(heights) - 1)
        (below, low), (above, high) = self.layers[upper - 1], self.layers[upper]
        below, above = to_millimetres(below), to_millimetres(above)
        share = (height - below) / (above - below)
        return {bearing: low[bearing] * (1.0 - share) + high[bearing] * share for bearing in BEARINGS}

    def radius(self, bearing: int, height: float) -> float:
        if len(self.layers) == 1:
            return self.layers[0][1][bearing]
        return self.at(to_millimetres(height)).get(bearing, 0.0)


def to_millimetres(length: float) -> float:
    """Rounded half away from zero."""
    scaled = length * 1000.0
    return (int(scaled + 0.5) if scaled >= 0.0 else -int(0.5 - scaled)) / 1000.0


def workspace(leg: Leg, identity: Array, *, layered: bool) -> Workspace:
    """Of a leg standing at `identity` (3,) in body. Without a foot there, all radii are zero."""
    if float(np.linalg.norm(identity - leg.tip())) > TOLERANCE:
        return Workspace(((0.0, dict.fromkeys(BEARINGS, 0.0)),))
    search = _Search(leg)
    if not layered:
        return Workspace(((0.0, search.radii(identity, LARGEST_RADIUS / LAYERS)),))
    lowest = -search.reach(identity, np.array([0.0, 0.0, -1.0]))
    highest = search.reach(identity, np.array([0.0, 0.0, 1.0]))
    gap = (highest - lowest) / LAYERS
    layers = {lowest: dict.fromkeys(BEARINGS, 0.0), highest: dict.fromkeys(BEARINGS, 0.0)}
    height = int(abs(highest) / gap) * gap
    while height >= lowest:
        layers[height] = search.radii(identity + np.array([0.0, 0.0, height]), gap)
        height -= gap
    return Workspace(tuple(sorted(layers.items())))


class _Search:
    """Steps of 2 mm with one solver step each, always beginning from the same posture."""

    def __init__(self, leg: Leg) -> None:
        self._begin = leg.simulated()

    def radii(self, origin: Array, gap: float) -> Radii:
        """About `origin`, after walking there over `gap` m; from then on searches begin at the posture found."""
        trial = self._begin.simulated()
        start, steps = trial.tip(), round(gap / STEP)
        for step in range(1, steps + 1):
            share = step / steps
            if trial.step_to(start * (1.0 - share) + origin * share) <= 0.0:
                break
        self._begin = trial
        radius: Radii = {}
        for bearing in BEARINGS[1:]:
            radius[bearing] = self.reach(origin, np.array([cos(radians(bearing)), sin(radians(bearing)), 0.0]))
        radius[0] = radius[360]
        return dict(sorted(radius.items()))

    def reach(self, origin: Array, direction: Array) -> float:
        """How far from `origin` the tip got along `direction` (3,) when the solver failed."""
        trial = self._begin.simulated()
        steps = round(LARGEST_RADIUS / STEP)
        for step in range(1, steps + 1):
            share = step / steps
            if trial.step_to(origin * (1.0 - share) + (origin + LARGEST_RADIUS * direction) * share) <= 0.0:
                break
        return float(np.linalg.norm(trial.tip() - origin))
