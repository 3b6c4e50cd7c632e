"""A flight of stairs among the flat places of a grid: levels that follow each other by one and the same rise."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from robot_agent.perception.flat_tops import FlatTop

FEWEST_RISES = 2
SMALLEST_RISE, LARGEST_RISE = 0.04, 0.30  # m, kerbs to what no building has
TOLERANCE = 0.12  # of the rise, by which a level may lie off its place


@dataclass(frozen=True, slots=True, kw_only=True)
class Stairs:
    """Levels at `lowest` + k * `rise`, k = 0 .. `rises`, none of them missing; m, in the grid's own height."""

    lowest: float
    rise: float
    rise_sigma: float
    rises: int


def find_stairs(levels: list[FlatTop]) -> Stairs | None:
    """The longest flight that the levels hold, the one of the largest area among equals; None if there is none.

    Every pair of levels proposes a flight.
    """
    best: tuple[int, float, Stairs] | None = None
    for low, high in combinations(sorted(levels, key=lambda level: level.middle), 2):
        proposed = high.middle - low.middle
        if not SMALLEST_RISE <= proposed <= LARGEST_RISE:
            continue
        flight = _climb(low, proposed, levels)
        if len(flight) - 1 < FEWEST_RISES:
            continue
        score = (len(flight), sum(level.area for level in flight))
        if best is None or score > best[:2]:
            best = (*score, _fitted(flight))
    return best[2] if best else None


def _climb(low: FlatTop, rise: float, levels: list[FlatTop]) -> list[FlatTop]:
    """Level after level, each the one nearest to a rise above the last."""
    flight = [low]
    while True:
        expected = flight[-1].middle + rise
        nearest = min(levels, key=lambda level: abs(level.middle - expected))
        if abs(nearest.height - expected) > TOLERANCE * rise:
            return flight
        flight.append(nearest)
        rise = (flight[-1].middle - low.middle) / (len(flight) - 1)


def _fitted(flight: list[FlatTop]) -> Stairs:
    """The median of all pairs' rises, which one level that is partly something else does not move (Theil, Sen)."""
    heights = np.array([level.middle for level in flight])
    low, high = np.triu_indices(len(flight), 1)
    rise = float(np.median((heights[high] - heights[low]) / (high - low)))
    order = np.arange(len(flight))
    lowest = float(np.median(heights - rise * order))
    residual = heights - lowest - rise * order
    spread = float(((order - order.mean()) ** 2).sum())
    sigma = float(np.sqrt((residual**2).sum() / max(1, len(flight) - 2) / spread))
    return Stairs(lowest=lowest, rise=rise, rise_sigma=sigma, rises=len(flight) - 1)
