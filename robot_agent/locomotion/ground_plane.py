"""The plane the feet stand on: z = a x + b y + c in body, from where the feet really are."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import solve_symmetric
from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def fit_plane(points: Array, weight: Array, plane: Array) -> float:
    """Fill `plane` (3,) with a, b, c by weighted least squares over `points` (n, 3); returns the rms residual, m.

    Where the points do not span a plane it is laid level through their mean.
    """
    normal, right, solution = np.zeros((3, 3)), np.zeros(3), np.zeros(3)
    total, mean_x, mean_y, mean_z = 0.0, 0.0, 0.0, 0.0
    for i in range(points.shape[0]):
        total += weight[i]
        mean_x += weight[i] * points[i, 0]
        mean_y += weight[i] * points[i, 1]
        mean_z += weight[i] * points[i, 2]
    if total < 1e-9:
        return 0.0
    mean_x, mean_y, mean_z = mean_x / total, mean_y / total, mean_z / total
    normal[2, 2] = total
    for i in range(points.shape[0]):
        x, y, z, w = points[i, 0] - mean_x, points[i, 1] - mean_y, points[i, 2] - mean_z, weight[i]
        normal[0, 0] += w * x * x
        normal[0, 1] += w * x * y
        normal[1, 1] += w * y * y
        right[0] += w * x * z
        right[1] += w * y * z
    normal[1, 0] = normal[0, 1]
    smallest = min(normal[0, 0], normal[1, 1])
    if not (smallest > 1e-6 and solve_symmetric(normal, right, solution)):
        solution[0], solution[1] = 0.0, 0.0
    plane[0], plane[1] = solution[0], solution[1]
    plane[2] = mean_z - plane[0] * mean_x - plane[1] * mean_y
    squares = 0.0
    for i in range(points.shape[0]):
        left = points[i, 2] - plane[0] * points[i, 0] - plane[1] * points[i, 1] - plane[2]
        squares += weight[i] * left * left
    return float(np.sqrt(squares / total))
