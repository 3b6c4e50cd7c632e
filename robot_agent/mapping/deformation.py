"""The map follows odometry that changes its mind: every cell moves as the pose did from which it was last seen.

Poses as they were when the ground was seen are remembered; when odometry corrects them, the difference at a cell's
last sighting, interpolated in time, carries the cell to its new place in x, y and z.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import ndimage

from robot_agent.mapping.rolling_grid import RollingGrid
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Layer = NDArray[np.float32]
Stamps = NDArray[np.int64]

LONGEST = 3600  # poses remembered: three minutes at 20 Hz
FEWEST_NEIGHBOURS = 5  # of eight known ones between which a cell left empty by the stretching is filled


class PosesAsUsed:
    """world_from_body of every frame as the map knows it, by stamp."""

    def __init__(self) -> None:
        self._poses: dict[int, Pose] = {}

    def add(self, stamp_ns: int, world_from_body: Pose) -> None:
        self._poses[stamp_ns] = world_from_body
        if len(self._poses) > LONGEST:
            del self._poses[next(iter(self._poses))]

    def changes(self, corrected: Mapping[int, Pose]) -> tuple[Stamps, list[Pose]]:
        """Stamps (m,) and new_from_old transforms of the world at the `corrected` poses that are remembered."""
        stamps = sorted(stamp for stamp in corrected if stamp in self._poses)
        changes = [corrected[stamp] @ self._poses[stamp].inverse() for stamp in stamps]
        return np.array(stamps, dtype=np.int64), changes

    def apply(self, stamps: Stamps, changes: list[Pose]) -> None:
        """From now on a pose is the one changed as at the nearest of `stamps`."""
        for stamp_ns, pose in self._poses.items():
            nearest = int(np.argmin(np.abs(stamps - stamp_ns)))
            self._poses[stamp_ns] = changes[nearest] @ pose


def largest_change(changes: list[Pose], about: Array) -> tuple[float, float]:
    """Largest shift in the plane and in height (m) that any of the changes gives the ground up to 1 m `about` (3,)."""
    places = about + np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    moved = np.concatenate([places @ change.rotation.T + change.position - places for change in changes])
    return float(np.hypot(moved[:, 0], moved[:, 1]).max()), float(np.abs(moved[:, 2]).max())


def deform(grid: RollingGrid, stamps: Stamps, changes: list[Pose]) -> None:
    """Carry all known cells of `grid` along; the layers of heights are moved, those of features left to be renewed."""
    rows, columns = (index.astype(np.int64) for index in np.nonzero(np.isfinite(grid.elevation)))
    if not len(rows):
        return
    world_rows = _world_index(rows, grid.row0, grid.size)
    world_columns = _world_index(columns, grid.column0, grid.size)
    seen = grid.seen_ns[rows, columns]
    rotations = np.array([change.rotation for change in changes], dtype=np.float64)
    positions = np.array([change.position for change in changes], dtype=np.float64)
    new_rows, new_columns, rise = carry_cells(
        world_rows, world_columns, grid.cell, grid.elevation[rows, columns], seen, stamps, rotations, positions
    )
    held = (new_rows >= grid.row0) & (new_rows < grid.row0 + grid.size)
    held &= (new_columns >= grid.column0) & (new_columns < grid.column0 + grid.size)
    # The last written stays where two cells come to lie in one: what was seen last.
    order = np.argsort(seen[held], kind="stable")
    old = rows[held][order], columns[held][order]
    new = new_rows[held][order] % grid.size, new_columns[held][order] % grid.size
    rise = rise[held][order]
    moved = {name: getattr(grid, name)[old] + rise for name in ("elevation", "upper", "ceiling", "contact")}
    moved["variance"] = grid.variance[old]
    accepted = grid.accepted[old]
    seen = seen[held][order]
    grid.clear()
    for name, values in moved.items():
        getattr(grid, name)[new] = values
    grid.seen_ns[new], grid.accepted[new] = seen, accepted
    _fill_gaps(grid)


@njit(cache=True)
def carry_cells(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    cell: float,
    elevation: Layer,
    seen_ns: NDArray[np.int64],
    stamps: Stamps,
    rotations: Array,
    positions: Array,
) -> tuple[NDArray[np.int64], NDArray[np.int64], Layer]:
    """New world row, column (k,) and rise (m) of cells listed by their world `rows` and `columns` (k,).

    `elevation` and `seen_ns` (k,) are theirs; the changes at `stamps` (m,) are `rotations` (m, 3, 3), `positions`.
    """
    count = rows.shape[0]
    new_rows, new_columns = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    rise = np.empty(count, dtype=np.float32)
    last = stamps.shape[0] - 1
    point, moved = np.empty(3), np.empty(3)
    for k in range(count):
        point[0], point[1], point[2] = (rows[k] + 0.5) * cell, (columns[k] + 0.5) * cell, elevation[k]
        after = min(int(np.searchsorted(stamps, seen_ns[k])), last)
        before = after if stamps[after] <= seen_ns[k] else max(0, after - 1)
        share = 0.0
        if after > before:
            share = (seen_ns[k] - stamps[before]) / (stamps[after] - stamps[before])
        for axis in range(3):
            moved[axis] = (1.0 - share) * _carried(rotations[before], positions[before], point, axis)
            moved[axis] += share * _carried(rotations[after], positions[after], point, axis)
        new_rows[k] = int(np.floor(moved[0] / cell))
        new_columns[k] = int(np.floor(moved[1] / cell))
        rise[k] = moved[2] - point[2]
    return new_rows, new_columns, rise


@njit(cache=True)
def _carried(rotation: Array, position: Array, point: Array, axis: int) -> float:
    turned = rotation[axis, 0] * point[0] + rotation[axis, 1] * point[1] + rotation[axis, 2] * point[2]
    return float(turned + position[axis])


def _world_index(stored: NDArray[np.int64], begin: int, size: int) -> NDArray[np.int64]:
    return np.asarray(begin + (stored - begin) % size, dtype=np.int64)


def _fill_gaps(grid: RollingGrid) -> None:
    """Single cells that the stretching left empty get the mean of their neighbours, and their doubt besides."""
    known = np.isfinite(grid.elevation)
    around = np.ones((3, 3))
    around[1, 1] = 0.0
    number = ndimage.convolve(known.astype(np.float64), around, mode="wrap")
    gaps = ~known & (number >= FEWEST_NEIGHBOURS)
    if not gaps.any():
        return
    for layer in (grid.elevation, grid.variance):
        total = ndimage.convolve(np.where(known, layer, 0.0).astype(np.float64), around, mode="wrap")
        layer[gaps] = (total[gaps] / number[gaps]).astype(np.float32)
    grid.upper[gaps], grid.accepted[gaps] = grid.elevation[gaps], 1
    grid.seen_ns[gaps] = ndimage.maximum_filter(grid.seen_ns, size=3, mode="wrap")[gaps]
