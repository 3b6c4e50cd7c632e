"""Where every leg may put its foot just now, for those who plan footholds."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot
from typing import Any

from numpy.typing import NDArray

from robot_agent.locomotion.walkspace import radius_towards

Array = NDArray[Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class LegReach:
    """Walkspaces about the stances, as the walker has them; its arrays go on changing with it."""

    stance_in_body: Array  # (legs, 3) m
    radius: Array  # (legs, bearings) m
    moved: Array  # (legs,) m that the stances have moved since
    lowest: float  # m, z in body of a foothold
    highest: float

    def beyond(self, leg: int, place: Array) -> tuple[float, float]:
        """How far a place (3,) m in body is from the leg's stance, and how far the leg walks in that direction, m."""
        x, y, _ = (place - self.stance_in_body[leg]).tolist()
        return hypot(x, y), max(float(radius_towards(self.radius[leg], x, y) - self.moved[leg]), 0.0)
