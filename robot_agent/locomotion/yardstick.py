"""A fixed piece of arithmetic by which machines are compared."""

import numpy as np

from robot_agent.kinematics.compiled import kernel


@kernel
def yardstick(turns: int) -> float:
    """Angles to directions and back, each turn depending on the last: what legs are computed with."""
    x, y = 0.6, 0.8
    for _ in range(turns):
        angle = np.arctan2(y, x) + 0.1
        x, y = np.cos(angle), np.sin(angle)
    return x
