"""Ground that an operator has forbidden, as polygons in a command (`navigation/keep_out.py` keeps the robot out)."""

from __future__ import annotations

from math import isfinite

import numpy as np

from robot_agent.navigation.keep_out import Area
from weaver_shared.errors import InputError
from weaver_shared.messages import Command

MOST_AREAS = 50
MOST_CORNERS = 400


def areas_of(command: Command) -> tuple[Area, ...]:
    """The areas in a command: its waypoints are their corners, its name tells how many each has. Raises InputError."""
    try:
        sizes = [int(word) for word in command.name.split()]
    except ValueError:
        raise InputError(f"areas are told by their corners' numbers, as '4 3'; not by {command.name!r:.40}") from None
    if len(sizes) > MOST_AREAS or len(command.waypoints) > MOST_CORNERS:
        raise InputError(f"at most {MOST_AREAS} areas with {MOST_CORNERS} corners can be forbidden")
    if any(size < 3 for size in sizes) or sum(sizes) != len(command.waypoints):
        raise InputError(
            f"an area has three corners or more, and all of them are told: {len(command.waypoints)} came for "
            f"{command.name!r:.40}"
        )
    if not all(isfinite(corner.x) and isfinite(corner.y) for corner in command.waypoints):
        raise InputError("the corners of an area are places: x and y must be finite numbers in metres")
    ends = np.cumsum(sizes)
    return tuple(command.waypoints[end - size : end] for end, size in zip(ends.tolist(), sizes, strict=True))
