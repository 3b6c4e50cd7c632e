"""The part of each leg's workspace in which it walks, and the velocity that keeps every stride within it.

A stride is centred on the stance, so a bearing counts no more than its opposite; it has to be within reach on higher
and lower ground; and unless the robot's description lets walkspaces overlap, a foot stays nearer to its own stance than
to any other leg's.
"""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def fill_walkspace(reach: Array, stance: Array, leg: int, overlapping: bool, radius: Array) -> None:
    """Set `radius` (BEARINGS,) m of one leg from its workspace `reach` (layers, BEARINGS) and all stances (legs, 3)."""
    bearings = radius.size
    for bearing in range(bearings):
        least = np.inf
        for side in range(2):
            towards = (bearing + side * (bearings // 2)) % bearings
            for layer in range(reach.shape[0]):
                least = min(least, reach[layer, towards])
            if not overlapping:
                least = min(least, _half_way(stance, leg, 2.0 * np.pi * towards / bearings))
        radius[bearing] = least


@kernel
def _half_way(stance: Array, leg: int, angle: float) -> float:
    """Distance, m, from a leg's stance at which another leg's is as near."""
    least = np.inf
    for other in range(stance.shape[0]):
        x, y = stance[other, 0] - stance[leg, 0], stance[other, 1] - stance[leg, 1]
        along = x * np.cos(angle) + y * np.sin(angle)
        if along > 1e-9:
            least = min(least, 0.5 * (x * x + y * y) / along)
    return least


@kernel
def radius_towards(radius: Array, x: float, y: float) -> float:
    """Radius of one leg (BEARINGS,) in the direction (x, y), linear between bearings."""
    place = np.arctan2(y, x) / (2.0 * np.pi) * radius.size
    lower = np.floor(place)
    share = place - lower
    first = int(lower) % radius.size
    towards: float = (1.0 - share) * radius[first] + share * radius[(first + 1) % radius.size]
    return towards


@kernel
def velocity_scale(
    velocity: Array, stance: Array, radius: Array, moved: Array, duty: float, frequency: float, largest_stride: float
) -> float:
    """Largest factor, at most 1, by which `velocity` (vx, vy, turn) keeps every leg's stride within its radius.

    `radius` (legs, BEARINGS) holds for stances `moved` (legs,) m from here.
    """
    scale = 1.0
    for leg in range(stance.shape[0]):
        x = velocity[0] - velocity[2] * stance[leg, 1]
        y = velocity[1] + velocity[2] * stance[leg, 0]
        half = 0.5 * np.sqrt(x * x + y * y) * duty / frequency
        if half > 0.0:
            room = max(radius_towards(radius[leg], x, y) - moved[leg], 0.0)
            scale = min(scale, min(room, 0.5 * largest_stride) / half)
    return scale
