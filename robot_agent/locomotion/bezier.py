"""Quartic Bezier curves, five nodes each (OpenSHC'20 eq. 17)."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def quartic(nodes: Array, t: float, point: Array) -> None:
    """Fill `point` (3,) with the curve of `nodes` (5, 3) at t in 0..1."""
    s = 1.0 - t
    b0, b1, b2, b3, b4 = s**4, 4.0 * s**3 * t, 6.0 * s * s * t * t, 4.0 * s * t**3, t**4
    for k in range(3):
        point[k] = b0 * nodes[0, k] + b1 * nodes[1, k] + b2 * nodes[2, k] + b3 * nodes[3, k] + b4 * nodes[4, k]


@kernel
def quartic_derivative(nodes: Array, t: float, slope: Array) -> None:
    """Fill `slope` (3,) with the derivative over t; divide by the curve's duration for a velocity."""
    s = 1.0 - t
    for k in range(3):
        slope[k] = 4.0 * (
            s**3 * (nodes[1, k] - nodes[0, k])
            + 3.0 * s * s * t * (nodes[2, k] - nodes[1, k])
            + 3.0 * s * t * t * (nodes[3, k] - nodes[2, k])
            + t**3 * (nodes[4, k] - nodes[3, k])
        )
