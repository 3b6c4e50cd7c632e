"""Energy stability: the least height the mass must be lifted to tip over an edge of the support polygon.

Normalised energy stability margin of Hirose, Tsukagoshi and Yoneda (1998), the energy of tipping over the weight:
|R| (1 - cos theta) cos psi for each edge, R from the edge to the centre of mass, theta its angle from the vertical
plane through the edge, psi the edge's slope. Unlike the static margin it counts slopes and the height of the mass.
"""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.stability import is_support_edge, seen_along_gravity

Array = NDArray[np.float64]


@kernel
def energy_margin(feet_in_body: Array, standing: NDArray[np.bool_], centre: Array, up: Array) -> float:
    """Least height, m, over all edges; negative when the mass has passed an edge, zero without a polygon."""
    beside = np.empty((feet_in_body.shape[0], 3))
    n = seen_along_gravity(feet_in_body, standing, centre, up, beside)
    least, edges = np.inf, 0
    for i in range(n):
        for j in range(n):
            if is_support_edge(beside, n, i, j):
                edges += 1
                first, second = feet_in_body[int(beside[i, 2])], feet_in_body[int(beside[j, 2])]
                height = tipping_height(first, second, centre, up)
                ex, ey = beside[j, 0] - beside[i, 0], beside[j, 1] - beside[i, 1]
                inside = ey * beside[i, 0] - ex * beside[i, 1] >= 0.0
                least = min(least, height if inside else -height)
    return least if n >= 3 and edges >= 3 else 0.0


@kernel
def tipping_height(first: Array, second: Array, centre: Array, up: Array) -> float:
    """By how much, m, `centre` rises when it turns about the line through two feet until it is highest."""
    ex, ey, ez = second[0] - first[0], second[1] - first[1], second[2] - first[2]
    length = sqrt(ex * ex + ey * ey + ez * ez)
    ex, ey, ez = ex / length, ey / length, ez / length
    rx, ry, rz = centre[0] - first[0], centre[1] - first[1], centre[2] - first[2]
    along = rx * ex + ry * ey + rz * ez
    rx, ry, rz = rx - along * ex, ry - along * ey, rz - along * ez
    slope = up[0] * ex + up[1] * ey + up[2] * ez
    highest = sqrt(rx * rx + ry * ry + rz * rz) * sqrt(max(1.0 - slope * slope, 0.0))
    # What `up` has along the edge does not count: R is normal to it.
    return float(highest - (rx * up[0] + ry * up[1] + rz * up[2]))
