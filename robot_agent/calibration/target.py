"""Calibration targets: where their corners are, numbered row by row from the lower left one as Kalibr does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.tags import FAMILY_SIZE
from weaver_shared.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class AprilGrid:
    """Tags of `tag_size` m with gaps of `spacing` times that; black squares in the gaps make every corner a saddle.

    The target's frame: origin at the lower left tag's lower left corner, x right, y up, z out of the paper.
    """

    columns: int
    rows: int
    tag_size: float
    spacing: float

    def __post_init__(self) -> None:
        if min(self.columns, self.rows) < 1 or self.columns * self.rows > FAMILY_SIZE:
            raise InputError(
                f"an AprilGrid has 1 to {FAMILY_SIZE} tags, {self.columns} x {self.rows} is outside of that"
            )
        if not 0.001 <= self.tag_size <= 10.0:
            raise InputError(f"a tag of {self.tag_size} m is no target; valid are 0.001 to 10 m")
        if not 0.05 <= self.spacing <= 1.0:
            raise InputError(f"a tag spacing of {self.spacing} is outside 0.05 to 1 (gap over tag size)")

    @property
    def pitch(self) -> float:
        """From one tag to the next, m."""
        return self.tag_size * (1.0 + self.spacing)

    @property
    def tags(self) -> int:
        return self.columns * self.rows

    @property
    def points(self) -> Array:
        """Corners (4 tags, 3) in the target's frame, m."""
        x = _edges(self.columns, self.pitch, self.tag_size)
        y = _edges(self.rows, self.pitch, self.tag_size)
        return np.stack([*(axis.ravel() for axis in np.meshgrid(x, y)), np.zeros(4 * self.tags)], axis=1)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height from the first corner to the last, m."""
        return self.columns * self.pitch - self.spacing * self.tag_size, (
            self.rows * self.pitch - self.spacing * self.tag_size
        )

    def corners_of(self, tag: int) -> NDArray[np.int64]:
        """Numbers of a tag's corners: lower left, lower right, upper right, upper left."""
        row, column = divmod(tag, self.columns)
        across = 2 * self.columns
        first = 2 * row * across + 2 * column
        return np.array([first, first + 1, first + across + 1, first + across])

    def __str__(self) -> str:
        return (
            f"AprilGrid of {self.columns} x {self.rows} tags, {1e3 * self.tag_size:.4g} mm with gaps of "
            f"{1e3 * self.tag_size * self.spacing:.4g} mm"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Checkerboard:
    """Inner corners of a chessboard: `columns` x `rows` of them, `column_spacing` and `row_spacing` m apart."""

    columns: int
    rows: int
    column_spacing: float
    row_spacing: float

    def __post_init__(self) -> None:
        if min(self.columns, self.rows) < 3:
            raise InputError(f"a chessboard needs at least 3 x 3 inner corners, not {self.columns} x {self.rows}")
        if not (0.001 <= self.column_spacing <= 10.0 and 0.001 <= self.row_spacing <= 10.0):
            raise InputError(
                f"squares of {self.column_spacing} x {self.row_spacing} m are no target; valid are 0.001 to 10 m"
            )

    @property
    def points(self) -> Array:
        """Corners (columns rows, 3) in the target's frame, m."""
        x = self.column_spacing * np.arange(self.columns)
        y = self.row_spacing * np.arange(self.rows)
        return np.stack([*(axis.ravel() for axis in np.meshgrid(x, y)), np.zeros(self.columns * self.rows)], axis=1)

    @property
    def size(self) -> tuple[float, float]:
        """Width and height from the first corner to the last, m."""
        return (self.columns - 1) * self.column_spacing, (self.rows - 1) * self.row_spacing

    def __str__(self) -> str:
        return (
            f"chessboard of {self.columns} x {self.rows} inner corners, squares of "
            f"{1e3 * self.column_spacing:.4g} x {1e3 * self.row_spacing:.4g} mm"
        )


Target = AprilGrid | Checkerboard


def _edges(count: int, pitch: float, tag_size: float) -> Array:
    """Both edges of every tag along one axis (2 count,), m."""
    return np.asarray((pitch * np.arange(count)[:, None] + np.array([0.0, tag_size])).ravel(), dtype=np.float64)
