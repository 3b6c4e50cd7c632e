"""Point clouds and elevation grids from NPZ files, whatever their makers called things."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.npz_files import read_npz

Array = NDArray[np.float64]

CLOUD_KEYS = ("xyz", "points", "cloud", "point_cloud")
GRID_KEYS = ("elevation", "height", "heights", "dem", "z")
NORMAL_KEYS = ("table_normal", "ground_normal", "plane_normal", "up")
NUMBERS = "fiu"  # kinds of numpy's types
FEWEST_ROWS = 3
CELL_KEYS = ("resolution", "cell", "cell_size", "dx")
WIDTHS = (320, 424, 480, 512, 640, 752, 848, 960, 1024, 1280, 1920)  # px that cameras have
BEHIND = 0.999  # share of the points, and how near their rays' slopes come to a line
DEGREE = 111_320.0
"""Metres of a degree of latitude: the spacing of grids given in degrees."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cloud:
    """Valid points (n, 3) in m and the labelled up direction, if the file has one; the label is for comparison only."""

    points: Array
    labelled_up: Array | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ElevationGrid:
    """Heights (rows, columns) in m, NaN unknown, of square cells of `cell` m; up is +z.

    `layers` are the file's other arrays of the same shape, as they are: for comparison only.
    """

    heights: Array
    cell: float
    layers: Mapping[str, Array] = field(default_factory=dict)


def load_terrain(path: Path, scale: float = 1.0) -> Cloud | ElevationGrid:
    """Read a cloud or grid, all its lengths times `scale`.

    Raises InputError that says what was found and what would be valid.
    """
    arrays = read_npz(path, "a terrain is an .npz file with a point cloud or an elevation grid")
    for key in CLOUD_KEYS:
        if key in arrays and arrays[key].shape[-1:] == (3,):
            _require_numbers(arrays[key], key, path)
            _require_in_front(arrays[key], arrays, path)
            return _cloud(arrays[key], _first(arrays, NORMAL_KEYS), path, scale)
    for key in GRID_KEYS:
        if key in arrays and arrays[key].ndim == 2:
            _require_numbers(arrays[key], key, path)
            return _grid(arrays[key], arrays, path, scale)
    found = ", ".join(f"{key} {array.shape}" for key, array in arrays.items()) or "nothing"
    raise InputError(
        f"{path} holds {found}; expected a cloud ({' or '.join(CLOUD_KEYS)}, shape (n, 3) or (h, w, 3)) "
        f"or a grid ({' or '.join(GRID_KEYS)}, shape (rows, columns))"
    )


def without_fill_value(heights: Array) -> Array:
    """The grid with an unobserved-cell value of zero made NaN.

    Zero is taken for such a value when it lies far under every other height, by more than ten of the grid's own steps,
    and all others are positive; a grid that marks unknown cells with NaN is left alone.
    """
    if np.isnan(heights).any() or not (heights == 0.0).any():
        return heights
    levels = np.unique(heights)
    if len(levels) < 3 or levels[0] < 0.0:
        return heights
    step = float(np.median(np.diff(levels[1:])))
    return np.where(heights == 0.0, np.nan, heights) if levels[1] > 10.0 * step else heights


def _require_numbers(array: NDArray[np.generic], key: str, path: Path) -> None:
    if array.dtype.kind not in NUMBERS:
        raise InputError(f"{path}: {key} has to be numbers in m, not {array.dtype}")


def _require_in_front(xyz: NDArray[np.generic], arrays: Mapping[str, NDArray[np.generic]], path: Path) -> None:
    """Raises InputError on a cloud laid out as a camera's picture with its points behind that camera.

    Such a cloud is known by its rays: x / z and y / z grow evenly with column and row, whatever lies there.
    """
    points = np.asarray(xyz, dtype=np.float64).reshape(-1, 3)
    valid = np.flatnonzero(np.isfinite(points).all(axis=1) & (points[:, 2] != 0.0))
    if len(valid) < 100 or float((points[valid, 2] < 0.0).mean()) < BEHIND:
        return
    x, y, z = points[valid].T
    told = [int(arrays["width"])] if "width" in arrays and arrays["width"].shape == () else WIDTHS
    for width in [xyz.shape[1]] if xyz.ndim == 3 else told:
        rows, columns = np.divmod(valid, max(1, width))
        if _line(columns, x / z) > BEHIND and _line(rows, y / z) > BEHIND:
            raise InputError(f"{path}: all points lie behind the camera (z < 0); z has to point forward, out of it")


def _line(a: Array | NDArray[np.intp], b: Array) -> float:
    """How near points lie to a line, 0..1: the correlation's size, 0 where one of the two is constant."""
    spread = float(np.std(a) * np.std(b))
    return abs(float(np.mean((a - a.mean()) * (b - b.mean())))) / spread if spread > 0.0 else 0.0


def _cloud(xyz: NDArray[np.generic], normal: NDArray[np.generic] | None, path: Path, scale: float) -> Cloud:
    points = np.asarray(xyz, dtype=np.float64).reshape(-1, 3)
    points = points[np.isfinite(points).all(axis=1) & (np.abs(points) > 0.0).any(axis=1)]
    if len(points) < 100:
        raise InputError(f"{path} has {len(points)} valid points; 100 are needed")
    up = None
    if normal is not None and normal.shape == (3,) and normal.dtype.kind in NUMBERS:
        length = float(np.linalg.norm(normal))
        up = np.asarray(normal, dtype=np.float64) / length if np.isfinite(length) and length > 0.0 else None
    return Cloud(points=points * scale, labelled_up=up)


def _grid(
    heights: NDArray[np.generic], arrays: Mapping[str, NDArray[np.generic]], path: Path, scale: float
) -> ElevationGrid:
    cell = _first(arrays, CELL_KEYS)
    numeric = cell is not None and cell.size == 1 and cell.dtype.kind in NUMBERS
    if cell is None or not numeric or not 0.0 < float(cell.reshape(())) < np.inf:
        raise InputError(f"{path}: an elevation grid needs its cell length in m ({' or '.join(CELL_KEYS)})")
    length = float(cell.reshape(()))
    if "xmin" in arrays and "dx" in arrays and length < 0.01:
        length *= DEGREE
    metres = np.asarray(heights, dtype=np.float64)
    if not np.issubdtype(heights.dtype, np.integer):
        metres = without_fill_value(metres)
    known = np.isfinite(metres)
    metres = np.where(known, metres, np.nan)
    if known.sum() < 100:
        raise InputError(f"{path} has {int(known.sum())} known cells; 100 are needed")
    if min(known.any(axis=1).sum(), known.any(axis=0).sum()) < FEWEST_ROWS:
        raise InputError(
            f"{path}: the known cells lie in fewer than {FEWEST_ROWS} rows or columns, which span no plane"
        )
    # Our own maps say what kind they are; their layers have other meanings by the same names.
    layers = {
        key: np.asarray(array, dtype=np.float64)
        for key, array in arrays.items()
        if "kind" not in arrays and array is not heights and array.shape == heights.shape and array.dtype.kind == "f"
    }
    return ElevationGrid(heights=metres * scale, cell=length * scale, layers=layers)


def _first(arrays: Mapping[str, NDArray[np.generic]], keys: tuple[str, ...]) -> NDArray[np.generic] | None:
    return next((arrays[key] for key in keys if key in arrays), None)
