"""Tiles of the map as they travel: int16 millimetres and uint8 indices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.rolling_grid import RollingGrid
from weaver_shared.messages import MapTile

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
    elevation, seen_ns = grid.elevation[place], grid.seen_ns[place]
    known = np.isfinite(elevation)
    millimetres = np.clip(np.rint(1000.0 * np.where(known, elevation, 0.0)), -32767, 32767)
    sigma = np.clip(np.rint(1000.0 * np.sqrt(np.where(known, grid.variance[place], 0.0))), 0, UNKNOWN - 1)
    age = np.clip((stamp_ns - seen_ns) // 1_000_000_000, 0, UNKNOWN - 1)
    return MapTile(
        stamp_ns=stamp_ns,
        i=i,
        j=j,
        size=grid.tile,
        cell=grid.cell,
        elevation_mm=np.where(known, millimetres, UNKNOWN_ELEVATION).astype(np.int16),
        sigma_mm=np.where(known, sigma, UNKNOWN).astype(np.uint8),
        roughness=_quantised_index(grid.roughness[place]),
        step_height=_quantised_index(grid.step_height[place]),
        age_s=np.where(known, age, UNKNOWN).astype(np.uint8),
    )


def worth_sending(tile: MapTile, sent: MapTile | None) -> bool:
    """Whether a tile differs from the one sent before by more than the pictures' noise."""
    if sent is None:
        return True
    return (
        _differs(tile.elevation_mm, sent.elevation_mm, UNKNOWN_ELEVATION, NOTICED_MM)
        or _differs(tile.roughness, sent.roughness, UNKNOWN, NOTICED_INDEX)
        or _differs(tile.step_height, sent.step_height, UNKNOWN, NOTICED_INDEX)
    )


def _differs(now: NDArray[Any], before: NDArray[Any], unknown: int, noticed: int) -> bool:
    """Any cell that became known or unknown, or a share of cells that moved by more than `noticed`."""
    known, was_known = now != unknown, before != unknown
    if bool((known != was_known).any()):
        return True
    moved = np.abs(now.astype(np.int32) - before.astype(np.int32)) > noticed
    return int(np.count_nonzero(moved & known)) > NOTICED_SHARE * int(np.count_nonzero(known))


def _quantised_index(layer: NDArray[np.float32]) -> NDArray[np.uint8]:
    scaled = np.clip(np.rint(FULL_SCALE * layer), 0, FULL_SCALE)
    return np.where(np.isfinite(layer), scaled, UNKNOWN).astype(np.uint8)
