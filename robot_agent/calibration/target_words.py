"""A target told in one line: its kind and its numbers."""

from __future__ import annotations

import math

from robot_agent.calibration.target import AprilGrid, Checkerboard, Target
from weaver_shared.errors import InputError

SYNTAX = (
    "aprilgrid COLUMNS ROWS TAG_SIZE SPACING or checkerboard COLUMNS ROWS SQUARE_SIZE, sizes in m, spacing over tag "
    "size; such as aprilgrid 6 6 0.088 0.3"
)


def target_of(text: str) -> Target:
    """A target from its name and numbers. Raises InputError that says how it is written."""
    kind, *numbers = text.split() or [""]
    try:
        values = [float(number) for number in numbers]
    except ValueError:
        values = []
    if not all(map(math.isfinite, values)):
        values = []
    if kind == "aprilgrid" and len(values) == 4:
        return AprilGrid(columns=int(values[0]), rows=int(values[1]), tag_size=values[2], spacing=values[3])
    if kind == "checkerboard" and len(values) == 3:
        return Checkerboard(
            columns=int(values[0]), rows=int(values[1]), column_spacing=values[2], row_spacing=values[2]
        )
    raise InputError(f"{text!r:.60} is no target; write {SYNTAX}")
