"""The highest point of every cell and what hangs over it, beside the elevation that a foot would find."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

Layer = NDArray[np.float32]


@njit(cache=True)
def renew_bounds(
    measured_upper: Layer,
    measured_ceiling: Layer,
    row0: int,
    column0: int,
    window_row: int,
    window_column: int,
    elevation: Layer,
    upper: Layer,
    ceiling: Layer,
    decay: float,
) -> None:
    """Take one frame's highest points and overhead points (n, n), NaN unseen, into the map's layers.

    The upper bound rises at once and sinks by the share `decay` of its height over the elevation for every frame that
    sees the cell lower; it is never under the elevation. The ceiling follows what is seen of it, half a step a frame.
    """
    size = elevation.shape[0]
    for i in range(measured_upper.shape[0]):
        row = row0 + i
        if row < window_row or row >= window_row + size:
            continue
        r = row % size
        for j in range(measured_upper.shape[1]):
            column = column0 + j
            if column < window_column or column >= window_column + size:
                continue
            c = column % size
            seen = measured_upper[i, j]
            if not np.isnan(seen) and not np.isnan(elevation[r, c]):
                old = upper[r, c]
                highest = max(seen, elevation[r, c])
                if np.isnan(old) or highest >= old:
                    upper[r, c] = highest
                else:
                    upper[r, c] = max(highest, old - decay * (old - elevation[r, c]))
            overhead = measured_ceiling[i, j]
            if not np.isnan(overhead):
                old = ceiling[r, c]
                ceiling[r, c] = overhead if np.isnan(old) else 0.5 * (old + overhead)
