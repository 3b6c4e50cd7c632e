"""What was there and is gone: a cell that lines of sight pass underneath is forgotten.

A farther point that was seen proves that nothing nearer rises into its line of sight. For every direction and distance
the lowest line to anything farther is enough to judge all cells, so the cost is that of one look at each cell.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from robot_agent.mapping.elevation_fusion import Extent

Layer = NDArray[np.float32]

DIRECTIONS = 360  # a degree each: at 1.2 m as wide as a cell of 2 cm
CELLS_BEYOND = 3  # by which a point has to be farther than the cell it speaks against


@njit(cache=True)
def forget_contradicted(
    measured: Layer,
    row0: int,
    column0: int,
    window_row: int,
    window_column: int,
    cell: float,
    sensor: NDArray[np.float64],
    elevation: Layer,
    variance: Layer,
    upper: Layer,
    contradicted: NDArray[np.uint8],
    clearance: float,
    contradictions: int,
) -> Extent:
    """Count against cells of the map not `measured` (n, n; NaN unseen) now but seen through from `sensor` (3,) m.

    Cells seen through in `contradictions` frames in a row become unknown; returns where. Only cells under the frame's
    square are judged. One direction alone does not speak: both beside it have to agree, which spares edges.
    """
    n, size = measured.shape[0], elevation.shape[0]
    lowest = _lowest_lines(measured, row0, column0, cell, sensor)
    first_row, first_column, last_row, last_column = 1 << 30, 1 << 30, -(1 << 30), -(1 << 30)
    distances = lowest.shape[1]
    for i in range(n):
        row = row0 + i
        if row < window_row or row >= window_row + size:
            continue
        r = row % size
        dx = (row + 0.5) * cell - sensor[0]
        for j in range(n):
            column = column0 + j
            if column < window_column or column >= window_column + size:
                continue
            c = column % size
            if np.isnan(elevation[r, c]):
                continue
            if not np.isnan(measured[i, j]):
                contradicted[r, c] = 0
                continue
            dy = (column + 0.5) * cell - sensor[1]
            distance = math.hypot(dx, dy)
            k = int(distance / cell) + CELLS_BEYOND
            if k >= distances:
                continue
            direction = _direction(dx, dy)
            line = lowest[direction, k]
            line = max(line, lowest[(direction + 1) % DIRECTIONS, k])
            line = max(line, lowest[(direction - 1) % DIRECTIONS, k])
            sure_top = elevation[r, c] - clearance - 2.0 * math.sqrt(variance[r, c])
            if sensor[2] + line * distance >= sure_top:
                continue
            contradicted[r, c] += 1
            if contradicted[r, c] < contradictions:
                continue
            elevation[r, c], variance[r, c], upper[r, c], contradicted[r, c] = np.nan, np.nan, np.nan, 0
            first_row, last_row = min(first_row, row), max(last_row, row)
            first_column, last_column = min(first_column, column), max(last_column, column)
    return Extent(first_row, first_column, last_row + 1, last_column + 1)


@njit(cache=True)
def _lowest_lines(
    measured: Layer, row0: int, column0: int, cell: float, sensor: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Least slope of the lines from the sensor to points at least k cells away, (directions, k); inf where none."""
    n = measured.shape[0]
    lowest = np.full((DIRECTIONS, n + CELLS_BEYOND + 1), np.inf)
    for i in range(n):
        dx = (row0 + i + 0.5) * cell - sensor[0]
        for j in range(n):
            z = measured[i, j]
            if np.isnan(z):
                continue
            dy = (column0 + j + 0.5) * cell - sensor[1]
            distance = math.hypot(dx, dy)
            k = min(int(distance / cell), lowest.shape[1] - 1)
            if distance < cell:
                continue
            slope = (z - sensor[2]) / distance
            # A cell fills the directions from one side of it to the other.
            direction, aside = _direction(dx, dy), int(0.5 * cell / distance * DIRECTIONS / (2.0 * math.pi) + 0.5)
            for d in range(direction - aside, direction + aside + 1):
                lowest[d % DIRECTIONS, k] = min(lowest[d % DIRECTIONS, k], slope)
    for direction in range(DIRECTIONS):
        for k in range(lowest.shape[1] - 2, -1, -1):
            lowest[direction, k] = min(lowest[direction, k], lowest[direction, k + 1])
    return lowest


@njit(cache=True)
def _direction(dx: float, dy: float) -> int:
    return int((math.atan2(dy, dx) / (2.0 * math.pi) + 1.0) * DIRECTIONS) % DIRECTIONS
