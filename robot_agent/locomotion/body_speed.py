"""One number for how fast a body moves: turning weighed against translation."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import Array

TURN_RADIUS = 0.4
"""m, about a foot's distance from the middle."""


@kernel
def speed_of(velocity: Array) -> float:
    """m/s of a velocity (vx, vy, turn)."""
    speed: float = np.sqrt(velocity[0] ** 2 + velocity[1] ** 2 + (TURN_RADIUS * velocity[2]) ** 2)
    return speed
