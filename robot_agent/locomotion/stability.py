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
    legs = feet_in_body.shape[0]
    x, y = np.empty(legs), np.empty(legs)
    n = 0
    for leg in range(legs):
        if standing[leg]:
            height = (feet_in_body[leg, 2] - centre[2]) / up[2]
            x[n] = feet_in_body[leg, 0] - centre[0] - height * up[0]
            y[n] = feet_in_body[leg, 1] - centre[1] - height * up[1]
            n += 1
    if n == 0:
        return -1.0
    margin, edges = np.inf, 0
    nearest = np.inf
    for i in range(n):
        nearest = min(nearest, sqrt(x[i] ** 2 + y[i] ** 2))
        for j in range(n):
            if i == j:
                continue
            ex, ey = x[j] - x[i], y[j] - y[i]
            length = sqrt(ex * ex + ey * ey)
            if length < 1e-9:
                continue
            inside = True
            for k in range(n):
                if ex * (y[k] - y[i]) - ey * (x[k] - x[i]) < -1e-9:
                    inside = False
            if inside:
                edges += 1
                margin = min(margin, (ey * x[i] - ex * y[i]) / length)
    if n < 3 or edges < 3:
        return -nearest
    return margin
