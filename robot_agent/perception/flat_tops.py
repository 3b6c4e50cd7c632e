"""Flat places of a height grid and how high they lie: tops of boxes, treads of stairs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Array = NDArray[np.float64]

FEWEST_CELLS = 10
SMALLEST_AREA = 0.0008  # m^2, about a foot's sole
STEEPEST = 0.2  # rise over run of what still counts as flat
TOP_QUANTILE = 0.9  # of a region's cells: what a foot has to clear, short of the noise's peaks
SAME_HEIGHT = 0.01  # m within which tops are one height


@dataclass(frozen=True, slots=True, kw_only=True)
class FlatTop:
    """One height at which there is level ground."""

    height: float  # m, what a foot has to clear
    middle: float  # m, the median of its cells
    area: float  # m^2


def flat_tops(heights: Array, cell: float) -> list[FlatTop]:
    """Flat connected regions of `heights` (rows, columns), NaN unknown, merged by height and sorted upwards."""
    known = np.isfinite(heights)
    if known.sum() < FEWEST_CELLS:
        return []
    high = ndimage.maximum_filter(np.where(known, heights, -np.inf), size=3)
    low = ndimage.minimum_filter(np.where(known, heights, np.inf), size=3)
    enough = ndimage.uniform_filter(known.astype(np.float64), size=3, mode="constant") > 6.5 / 9.0
    span = np.where(known & enough, high - low, np.inf)
    if not np.isfinite(span).any():
        return []
    # Most ground is flat: what its calmer quarter spans is noise, and a jump of several times that is an edge.
    noise = float(np.quantile(span[np.isfinite(span)], 0.25))
    tolerance = min(max(2.0 * noise, 0.5 * STEEPEST * cell, 0.003), max(0.03, STEEPEST * cell))
    labels, number = ndimage.label(span < tolerance)
    tops = [_top(heights, cell, labels == k) for k in range(1, number + 1)]
    return _merged(sorted((top for top in tops if top is not None), key=lambda top: top.height))


def _top(heights: Array, cell: float, region: NDArray[np.bool_]) -> FlatTop | None:
    cells = int(region.sum())
    if cells < FEWEST_CELLS or cells * cell**2 < SMALLEST_AREA:
        return None
    rows, columns = np.nonzero(region)
    z = heights[region]
    design = np.column_stack([(rows - rows.mean()) * cell, (columns - columns.mean()) * cell])
    slopes, *_ = np.linalg.lstsq(design, z - z.mean(), rcond=None)
    if float(np.hypot(*slopes)) > STEEPEST:
        return None
    return FlatTop(height=float(np.quantile(z, TOP_QUANTILE)), middle=float(np.median(z)), area=cells * cell**2)


def _merged(tops: list[FlatTop]) -> list[FlatTop]:
    groups: list[list[FlatTop]] = []
    for top in tops:
        if groups and top.height - groups[-1][-1].height < SAME_HEIGHT:
            groups[-1].append(top)
        else:
            groups.append([top])
    return [_joined(group) for group in groups]


def _joined(group: list[FlatTop]) -> FlatTop:
    area = sum(top.area for top in group)
    return FlatTop(
        height=sum(top.height * top.area for top in group) / area,
        middle=sum(top.middle * top.area for top in group) / area,
        area=area,
    )
