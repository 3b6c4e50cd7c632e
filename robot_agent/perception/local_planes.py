"""Slope and roughness of every cell of a finished grid, from the plane through the cells in a circle about it.

The plane is the total-least-squares one, as in ETH's traversability filters (the normal is the smallest principal
axis), so that finished maps can be compared with theirs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FEWEST_CELLS = 3
RADIUS = 0.05  # m, ETH's


@dataclass(frozen=True, slots=True, kw_only=True)
class LocalPlanes:
    """Layers (rows, columns), NaN where fewer than three cells in a line or less are known about a known cell."""

    radius: float  # m
    slope: Array  # rad from level
    roughness: Array  # m, standard deviation of the cells about the plane, along its normal


def local_planes(heights: Array, cell: float, radius: float = RADIUS) -> LocalPlanes:
    """Planes through the known cells of `heights` (rows, columns) in m, NaN unknown, within `radius` m of each cell.

    A circle narrower than the next cells is widened to hold the eight neighbours.
    """
    radius = max(radius, 1.5 * cell)
    number, first, second = _moments(heights, cell, radius)
    count = np.maximum(number, 1.0)[..., None]
    mean = first / count
    covariance = second / count[..., None] - mean[..., :, None] * mean[..., None, :]
    spread, axes = np.linalg.eigh(covariance)
    normal = axes[..., :, 0]
    slope = np.arccos(np.clip(np.abs(normal[..., 2]), 0.0, 1.0))
    roughness = np.sqrt(np.maximum(spread[..., 0], 0.0) * number / np.maximum(number - 1.0, 1.0))
    # Cells in one line leave the plane free to turn about it.
    determined = np.isfinite(heights) & (number >= FEWEST_CELLS) & (spread[..., 1] > 1e-9 * cell**2)
    return LocalPlanes(
        radius=radius, slope=np.where(determined, slope, np.nan), roughness=np.where(determined, roughness, np.nan)
    )


def _moments(heights: Array, cell: float, radius: float) -> tuple[Array, Array, Array]:
    """Number (rows, columns), sum (.., 3) and sum of outer products (.., 3, 3) of the circle's points.

    Points are relative to their own cell's place and height, which keeps the sums small.
    """
    rows, columns = heights.shape
    reach = int(radius / cell + 1e-9)
    padded = np.pad(heights, reach, constant_values=np.nan)
    number = np.zeros(heights.shape)
    first = np.zeros((rows, columns, 3))
    second = np.zeros((rows, columns, 3, 3))
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            if np.hypot(i, j) * cell > radius + 1e-9:
                continue
            z = padded[reach + i : reach + i + rows, reach + j : reach + j + columns] - heights
            known = np.isfinite(z)
            point = np.stack([np.where(known, i * cell, 0.0), np.where(known, j * cell, 0.0), np.where(known, z, 0.0)])
            number += known
            first += np.moveaxis(point, 0, -1)
            second += np.einsum("aij,bij->ijab", point, point)
    return number, first, second
