"""Disparities to the highest point of each world grid cell, in one pass over the picture (ICRA'17 III-D, DEM)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from robot_agent.perception.working_camera import WorkingCamera
from weaver_shared.config.perception import GridConfig, MatchingConfig
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

SUBPIXELS = 16
"""OpenCV gives disparities as integer sixteenths of a pixel."""

INDEPENDENT_POINTS = 8.0
"""Matching smooths over its window, so about this many neighbouring points share one error."""

LARGEST_DISPARITY = 256  # px

# What is gathered of a cell lies side by side, in one line of the processor's cache.
_HIGHEST, _VARIANCE, _SUM, _NUMBER = range(4)
_TOP_FIELDS = 4

BORDER = 3  # px at the top and bottom, where half a matching window is missing


@dataclass(frozen=True, slots=True, kw_only=True)
class HeightGrid:
    """Square of world cells; cell (r, c) is centred at ((row0 + r + 0.5) * cell, (column0 + c + 0.5) * cell)."""

    row0: int
    column0: int
    cell: float  # m
    elevation: NDArray[np.float32]  # (n, n) world z in m of the cell's top, NaN unknown
    variance: NDArray[np.float32]  # (n, n) m^2
    upper: NDArray[np.float32]  # (n, n) world z in m of the cell's very highest point, NaN unknown
    ceiling: NDArray[np.float32]  # (n, n) world z in m of the lowest thing overhead, NaN where nothing was seen

    def at(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Elevation and variance of the cells that hold the points; NaN outside."""
        rows = np.floor(x / self.cell).astype(np.int64) - self.row0
        columns = np.floor(y / self.cell).astype(np.int64) - self.column0
        size = self.elevation.shape[0]
        inside = (rows >= 0) & (rows < size) & (columns >= 0) & (columns < size)
        rows, columns = np.where(inside, rows, 0), np.where(inside, columns, 0)
        elevation = np.where(inside, self.elevation[rows, columns], np.nan)
        variance = np.where(inside, self.variance[rows, columns], np.nan)
        return elevation, variance


class _Projection(NamedTuple):
    """Pixels to world: ray slopes of columns and rows, depth and its sigma by sixteenths of disparity, pose."""

    columns: Array
    rows: Array
    depths: Array
    depth_sigmas: Array
    smallest: int
    rotation: Array
    position: Array


class _Gate(NamedTuple):
    """Expected ground z = a x + b y + c, half height at the camera and its growth with distance, reach (m).

    What is higher than the gate and within `headroom` m of the ground hangs overhead. `nearest` is the least depth in m
    that the matcher can find: a ray that meets the expected ground before it has nothing true to show.
    """

    a: float
    b: float
    c: float
    height: float
    slope: float
    reach: float
    headroom: float
    nearest: float


class _Cells(NamedTuple):
    row0: int
    column0: int
    size: int
    cell: float


class _Points(NamedTuple):
    """Accepted points in the order met: flat cell index and height."""

    cell: NDArray[np.int32]
    height: NDArray[np.float32]


class DisparityGrid:
    """Turns one disparity picture into a `HeightGrid` about the camera; keeps its scratch memory."""

    def __init__(self, camera: WorkingCamera, config: GridConfig, matching: MatchingConfig) -> None:
        self._config = config
        self._smallest = max(1, round(matching.smallest_disparity * SUBPIXELS))
        self._columns, self._rows = camera.ray_slopes()
        pixels = camera.width * camera.height
        self._points = _Points(
            cell=np.empty(pixels, dtype=np.int32),
            height=np.empty(pixels, dtype=np.float32),
        )
        self._half = math.ceil(config.reach / config.cell)
        disparity = np.maximum(np.arange(LARGEST_DISPARITY * SUBPIXELS), 1) / SUBPIXELS
        self._depths = camera.focal_length * camera.baseline / disparity
        self._depth_sigmas = self._depths / disparity * matching.disparity_sigma
        self._nearest = camera.focal_length * camera.baseline / (matching.disparities - 1)

    def fuse(
        self,
        disparity: NDArray[np.int16],
        world_from_camera: Pose,
        ground: tuple[float, float, float],
    ) -> HeightGrid:
        """Highest points of `disparity` (height, width), sixteenths of a pixel, invalid where not positive.

        `ground` is (a, b, c) of the expected ground z = a x + b y + c in world; points far off it are left out.
        """
        config = self._config
        size = 2 * self._half + 1
        row, column = (math.floor(p / config.cell) - self._half for p in world_from_camera.position[:2])
        projection = _Projection(
            columns=self._columns,
            rows=self._rows,
            depths=self._depths,
            depth_sigmas=self._depth_sigmas,
            smallest=self._smallest,
            rotation=np.ascontiguousarray(world_from_camera.rotation, dtype=np.float64),
            position=np.ascontiguousarray(world_from_camera.position, dtype=np.float64),
        )
        a, b, c = (float(value) for value in ground)
        gate = _Gate(
            a=a,
            b=b,
            c=c,
            height=config.height_gate,
            slope=config.gate_slope,
            reach=config.reach,
            headroom=config.headroom,
            nearest=self._nearest,
        )
        cells = _Cells(row0=row, column0=column, size=size, cell=config.cell)
        tops = np.zeros((size * size, _TOP_FIELDS), dtype=np.float32)
        tops[:, _HIGHEST] = -np.inf
        overhead = np.full(size * size, np.inf, dtype=np.float32)
        count = _list_points(disparity, projection, gate, cells, self._points, tops, overhead)
        elevation, variance, upper = _average_tops(count, self._points, tops, config.top_band, config.min_points)
        overhead[np.isinf(overhead)] = np.nan
        layers = [layer.reshape(size, size) for layer in (elevation, variance, upper, overhead)]
        for surface in (layers[0], layers[3]):
            _drop_lonely(surface, config.companions, config.companion_step)
        return HeightGrid(
            row0=row,
            column0=column,
            cell=config.cell,
            elevation=layers[0],
            variance=layers[1],
            upper=np.where(np.isnan(layers[0]), np.float32(np.nan), layers[2]),
            ceiling=layers[3],
        )


@njit(cache=True)
def _list_points(
    disparity: NDArray[np.int16],
    projection: _Projection,
    gate: _Gate,
    cells: _Cells,
    points: _Points,
    tops: NDArray[np.float32],
    overhead: NDArray[np.float32],
) -> int:
    """List the points within reach and gate; `tops` gets each cell's highest, `overhead` its lowest above the gate.

    Returns the number listed.
    """
    height, width = disparity.shape
    rotation, position = projection.rotation, projection.position
    # World direction of each column, to which a row adds its own; scaled to cells in the plane.
    per_cell = 1.0 / cells.cell
    x_column = rotation[0, 0] * projection.columns
    y_column = rotation[1, 0] * projection.columns
    z_column = rotation[2, 0] * projection.columns
    x0, y0 = position[0] * per_cell - cells.row0, position[1] * per_cell - cells.column0
    ground = gate.a * position[0] + gate.b * position[1] + gate.c
    smallest, largest = projection.smallest, projection.depths.shape[0] - 1
    reach_squared, slope_squared = gate.reach * gate.reach, gate.slope * gate.slope
    # Rays that sink faster than this towards the ground meet it nearer than anything can be matched.
    steepest = (ground - position[2]) / gate.nearest
    sinking_column = z_column - gate.a * x_column - gate.b * y_column
    listed = 0
    for v in range(BORDER, height - BORDER):
        row_slope = projection.rows[v]
        x_row = rotation[0, 1] * row_slope + rotation[0, 2]
        y_row = rotation[1, 1] * row_slope + rotation[1, 2]
        z_row = rotation[2, 1] * row_slope + rotation[2, 2]
        steepest_column = steepest - (z_row - gate.a * x_row - gate.b * y_row)
        for u in range(width):
            d = disparity[v, u]
            if d < smallest or d > largest or sinking_column[u] < steepest_column:
                continue
            depth = projection.depths[d]
            dx, dy = depth * (x_column[u] + x_row), depth * (y_column[u] + y_row)
            distance_squared = dx * dx + dy * dy
            if distance_squared > reach_squared:
                continue
            z_slope = z_column[u] + z_row
            z = position[2] + depth * z_slope
            above = z - ground - gate.a * dx - gate.b * dy
            beyond = abs(above) - gate.height
            outside = beyond > 0.0 and beyond * beyond > slope_squared * distance_squared
            if outside and (above < 0.0 or above > gate.headroom):
                continue
            row, column = int(x0 + dx * per_cell), int(y0 + dy * per_cell)
            if row < 0 or row >= cells.size or column < 0 or column >= cells.size:
                continue
            index = row * cells.size + column
            if outside:
                overhead[index] = min(overhead[index], np.float32(z))
                continue
            points.cell[listed] = index
            points.height[listed] = z
            listed += 1
            tops[index, _HIGHEST] = max(tops[index, _HIGHEST], np.float32(z))
            # A depth error moves the point along its ray; its height moves by the ray's vertical part. The points of
            # one cell differ little in this.
            sigma = projection.depth_sigmas[d] * z_slope
            tops[index, _VARIANCE] = sigma * sigma
    return listed


@njit(cache=True)
def _average_tops(
    count: int, points: _Points, tops: NDArray[np.float32], band: float, min_points: int
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """Mean of the points in the band under each cell's highest, its top without a maximum's bias; variance; highest."""
    for k in range(count):
        index = points.cell[k]
        if points.height[k] >= tops[index, _HIGHEST] - band:
            tops[index, _SUM] += points.height[k]
            tops[index, _NUMBER] += np.float32(1.0)
    cells = tops.shape[0]
    elevation = np.full(cells, np.nan, dtype=np.float32)
    variance = np.full(cells, np.nan, dtype=np.float32)
    upper = np.full(cells, np.nan, dtype=np.float32)
    for index in range(cells):
        n = tops[index, _NUMBER]
        if n >= min_points:
            elevation[index] = tops[index, _SUM] / n
            variance[index] = tops[index, _VARIANCE] / (1.0 + (n - 1.0) / INDEPENDENT_POINTS)
            upper[index] = tops[index, _HIGHEST]
    return elevation, variance, upper


@njit(cache=True)
def _drop_lonely(elevation: NDArray[np.float32], companions: int, step: float) -> None:
    """Forget cells with fewer than `companions` cells near their height about them: mistakes of the matcher."""
    size = elevation.shape[0]
    lonely = np.zeros(elevation.shape, dtype=np.bool_)
    for r in range(size):
        for c in range(size):
            z = elevation[r, c]
            if np.isnan(z):
                continue
            alike = -1
            for i in range(max(0, r - 2), min(size, r + 3)):
                for j in range(max(0, c - 2), min(size, c + 3)):
                    if abs(elevation[i, j] - z) < step:
                        alike += 1
            lonely[r, c] = alike < companions
    for r in range(size):
        for c in range(size):
            if lonely[r, c]:
                elevation[r, c] = np.nan
