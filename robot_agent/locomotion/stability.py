"""Static stability: how far the centre of mass, seen along gravity, lies inside the polygon of the standing feet."""

from math import sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def centre_of_mass(origins: Array, link_mass: Array, trunk_mass: float, trunk_centre: Array, centre: Array) -> None:
    """Fill `centre` (3,) in body: trunk and links, each link's mass half-way along it. `origins` (legs, n + 1, 3)."""
    total = trunk_mass
    for k in range(3):
        centre[k] = trunk_mass * trunk_centre[k]
    for leg in range(origins.shape[0]):
        for i in range(link_mass.size):
            total += link_mass[i]
            for k in range(3):
                centre[k] += 0.5 * link_mass[i] * (origins[leg, i, k] + origins[leg, i + 1, k])
    for k in range(3):
        centre[k] /= total


@kernel
def static_margin(feet_in_body: Array, standing: NDArray[np.bool_], centre: Array, up: Array) -> float:
    """Least distance, m, from the projected centre of mass to an edge of the support polygon; negative outside.

    With fewer than three feet on the ground there is no polygon: minus the distance to the nearest line or foot.
    """
    beside = np.empty((feet_in_body.shape[0], 3))
    n = seen_along_gravity(feet_in_body, standing, centre, up, beside)
    if n == 0:
        return -1.0
    margin, edges, nearest = np.inf, 0, np.inf
    for i in range(n):
        nearest = min(nearest, sqrt(beside[i, 0] ** 2 + beside[i, 1] ** 2))
        for j in range(n):
            if is_support_edge(beside, n, i, j):
                ex, ey = beside[j, 0] - beside[i, 0], beside[j, 1] - beside[i, 1]
                edges += 1
                margin = min(margin, (ey * beside[i, 0] - ex * beside[i, 1]) / sqrt(ex * ex + ey * ey))
    if n < 3 or edges < 3:
        return -nearest
    return margin


@kernel
def seen_along_gravity(
    feet_in_body: Array, standing: NDArray[np.bool_], centre: Array, up: Array, beside: Array
) -> int:
    """Fill rows of `beside` (legs, 3): x and y of the standing feet from the centre of mass, sheared so that gravity
    falls along z, and the leg's number. Returns how many stand."""
    n = 0
    for leg in range(feet_in_body.shape[0]):
        if standing[leg]:
            height = (feet_in_body[leg, 2] - centre[2]) / up[2]
            beside[n, 0] = feet_in_body[leg, 0] - centre[0] - height * up[0]
            beside[n, 1] = feet_in_body[leg, 1] - centre[1] - height * up[1]
            beside[n, 2] = leg
            n += 1
    return n


@kernel
def is_support_edge(beside: Array, n: int, i: int, j: int) -> bool:
    """Whether foot i to foot j is an edge of the support polygon, all other feet on its left."""
    ex, ey = beside[j, 0] - beside[i, 0], beside[j, 1] - beside[i, 1]
    if ex * ex + ey * ey < 1e-18:
        return False
    least = np.inf
    for k in range(n):
        least = min(least, ex * (beside[k, 1] - beside[i, 1]) - ey * (beside[k, 0] - beside[i, 0]))
    return bool(least >= -1e-9)
