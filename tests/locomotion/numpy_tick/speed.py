"""One number for a body's velocity."""

import numpy as np

from robot_agent.locomotion.body_speed import TURN_RADIUS


def speed_of(velocity):
    """m/s: turning counts like a foot's speed."""
    return np.linalg.norm(velocity * [1.0, 1.0, TURN_RADIUS])
