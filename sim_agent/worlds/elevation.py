"""True elevation: the highest surface hit by a vertical line."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

SEAM = 1e-9
"""m by which a box reaches beyond its faces, so that no line falls between two that touch."""


@njit(cache=True)
def highest_box(x: Array, y: Array, centre: Array, half: Array, rotation: Array, height: Array) -> None:
    """Raise `height` (n,) to the top of any box (centre (m, 3), half (m, 3), rotation (m, 3, 3)) above (x, y)."""
    for k in range(centre.shape[0]):
        reach = np.sqrt(half[k, 0] ** 2 + half[k, 1] ** 2 + half[k, 2] ** 2)
        for i in range(x.shape[0]):
            dx, dy = x[i] - centre[k, 0], y[i] - centre[k, 1]
            if abs(dx) > reach or abs(dy) > reach:
                continue
            low, high = -1e9, 1e9
            for axis in range(3):
                offset = rotation[k, 0, axis] * dx + rotation[k, 1, axis] * dy
                slope = rotation[k, 2, axis]
                if abs(slope) < 1e-12:
                    if abs(offset) > half[k, axis] + SEAM:
                        high = -2e9
                    continue
                near = (-half[k, axis] - offset) / slope
                far = (half[k, axis] - offset) / slope
                low = max(low, min(near, far))
                high = min(high, max(near, far))
            if high >= low:
                height[i] = max(height[i], centre[k, 2] + high)


@njit(cache=True)
def heightfield_elevation(x: Array, y: Array, x0: float, y0: float, cell: float, z: Array, height: Array) -> None:
    """Raise `height` (n,) to the triangulated grid z (nx, ny); points beside the grid are left as they are."""
    nx, ny = z.shape
    for index in range(x.shape[0]):
        u, v = (x[index] - x0) / cell, (y[index] - y0) / cell
        if not (0.0 <= u <= nx - 1 and 0.0 <= v <= ny - 1):
            continue
        i, j = min(int(u), nx - 2), min(int(v), ny - 2)
        a, b = u - i, v - j
        if a + b <= 1.0:
            found = z[i, j] + a * (z[i + 1, j] - z[i, j]) + b * (z[i, j + 1] - z[i, j])
        else:
            corner = z[i + 1, j + 1]
            found = corner + (1.0 - a) * (z[i, j + 1] - corner) + (1.0 - b) * (z[i + 1, j] - corner)
        height[index] = max(height[index], found)
