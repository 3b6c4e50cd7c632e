"""The robot's footprint on a grid: how near to an obstacle each place is, and what that costs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.navigation.compiled import kernel

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@kernel
def add_clearance(
    blocked: Flags, cell: float, radius: float, comfort: float, weight: float, cost: Array, barred: Flags
) -> None:
    """Bar every cell whose middle is nearer than `radius` m to a blocked one, and raise `cost` (rows, columns) by up
    to `weight` within `comfort` m beyond. The circle is the one about the robot's feet, so it may turn anywhere."""
    rows, columns = blocked.shape
    reach = int(np.ceil((radius + comfort) / cell))
    nearest = np.full((rows, columns), np.inf)
    for r in range(rows):
        for c in range(columns):
            if not blocked[r, c]:
                continue
            for i in range(max(r - reach, 0), min(r + reach + 1, rows)):
                for j in range(max(c - reach, 0), min(c + reach + 1, columns)):
                    square = float((i - r) * (i - r) + (j - c) * (j - c))
                    nearest[i, j] = min(nearest[i, j], square)
    for r in range(rows):
        for c in range(columns):
            distance = np.sqrt(nearest[r, c]) * cell
            barred[r, c] = distance < radius
            if distance < radius + comfort:
                cost[r, c] += weight * min((radius + comfort - distance) / comfort, 1.0)
