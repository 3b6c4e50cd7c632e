"""Tiles of the map as they travel: int16 millimetres and uint8 indices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from robot_agent.mapping.rolling_grid import RollingGrid
from weaver_shared.messages import MapTile

Layer = NDArray[np.float32]
Bytes = NDArray[np.uint8]

NOTICED_MM = 3
NOTICED_INDEX = 10
NOTICED_SHARE = 0.02
"""A tile is sent again when more than this share of its cells moved by more than 3 mm or 5 % of an index."""

UNKNOWN_ELEVATION = -32768
UNKNOWN = 255
FULL_SCALE = 200
"""Quantised value of roughness or step height 1."""


def quantised_tile(grid: RollingGrid, i: int, j: int, stamp_ns: int) -> MapTile:
    """Tile (i, j), counted in tiles from the world's origin, as of `stamp_ns`."""
    place = grid.rows_of_tile(i), grid.rows_of_tile(j)
    elevation, sigma, roughness, step_height, age = _quantise(
        grid.elevation[place],
        grid.variance[place],
        grid.roughness[place],
        grid.step_height[place],
        grid.seen_ns[place],
        stamp_ns,
    )
    return MapTile(
        stamp_ns=stamp_ns,
        i=i,
        j=j,
        size=grid.tile,
        cell=grid.cell,
        elevation_mm=elevation,
        sigma_mm=sigma,
        roughness=roughness,
        step_height=step_height,
        age_s=age,
    )


def worth_sending(tile: MapTile, sent: MapTile | None) -> bool:
    """Whether a tile differs from the one sent before by more than the pictures' noise."""
    if sent is None:
        return True
    return bool(
        _differs(tile.elevation_mm, sent.elevation_mm, UNKNOWN_ELEVATION, NOTICED_MM)
        or _differs(tile.roughness, sent.roughness, UNKNOWN, NOTICED_INDEX)
        or _differs(tile.step_height, sent.step_height, UNKNOWN, NOTICED_INDEX)
    )


@njit(cache=True)
def _differs(now: NDArray[Any], before: NDArray[Any], unknown: int, noticed: int) -> bool:
    """Any cell that became known or unknown, or a share of cells that moved by more than `noticed`."""
    known, moved = 0, 0
    for value, old in zip(now.flat, before.flat):  # noqa: B905 - numba knows no strict
        if (value == unknown) != (old == unknown):
            return True
        if value != unknown:
            known += 1
            moved += abs(int(value) - int(old)) > noticed
    return bool(moved > NOTICED_SHARE * known)


@njit(cache=True)
def _quantise(
    elevation: Layer, variance: Layer, roughness: Layer, step_height: Layer, seen_ns: NDArray[np.int64], stamp_ns: int
) -> tuple[NDArray[np.int16], Bytes, Bytes, Bytes, Bytes]:
    """Elevation (mm), sigma (mm), roughness, step height and age (s) of a tile's cells as they travel."""
    shape = elevation.shape
    millimetres, sigma = np.full(shape, UNKNOWN_ELEVATION, dtype=np.int16), np.full(shape, UNKNOWN, dtype=np.uint8)
    rough, step = np.full(shape, UNKNOWN, dtype=np.uint8), np.full(shape, UNKNOWN, dtype=np.uint8)
    age = np.full(shape, UNKNOWN, dtype=np.uint8)
    for r in range(shape[0]):
        for c in range(shape[1]):
            if np.isfinite(elevation[r, c]):
                millimetres[r, c] = min(max(np.rint(1000.0 * elevation[r, c]), -32767.0), 32767.0)
                sigma[r, c] = min(np.rint(1000.0 * np.sqrt(variance[r, c])), UNKNOWN - 1.0)
                age[r, c] = min(max((stamp_ns - seen_ns[r, c]) // 1_000_000_000, 0), UNKNOWN - 1)
            if np.isfinite(roughness[r, c]):
                rough[r, c] = min(max(np.rint(FULL_SCALE * roughness[r, c]), 0.0), FULL_SCALE)
            if np.isfinite(step_height[r, c]):
                step[r, c] = min(max(np.rint(FULL_SCALE * step_height[r, c]), 0.0), FULL_SCALE)
    return millimetres, sigma, rough, step, age
