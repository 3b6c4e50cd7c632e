"""Joint speed limits that keep feet on their paths: a leg too fast is slowed as a whole, never joint by joint."""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def limit_joint_speed(
    previous: Array, wanted: Array, speed_limit: Array, together: NDArray[np.bool_], dt: float
) -> float:
    """Shorten the step `previous` -> `wanted` (legs, n), in place, until no joint exceeds `speed_limit` (n,) rad/s.

    Legs marked `together` (legs,), those on the ground, share the smallest factor so that their feet do not drag
    against each other; the others each have their own. Returns the shared factor, 1 when nothing was limited.
    """
    shared = 1.0
    for leg in range(wanted.shape[0]):
        factor = 1.0
        for i in range(wanted.shape[1]):
            step = abs(wanted[leg, i] - previous[leg, i])
            if step > speed_limit[i] * dt:
                factor = min(factor, speed_limit[i] * dt / step)
        if together[leg]:
            shared = min(shared, factor)
        elif factor < 1.0:
            _shorten(previous[leg], wanted[leg], factor)
    if shared < 1.0:
        for leg in range(wanted.shape[0]):
            if together[leg]:
                _shorten(previous[leg], wanted[leg], shared)
    return shared


@kernel
def _shorten(previous: Array, wanted: Array, factor: float) -> None:
    for i in range(wanted.size):
        wanted[i] = previous[i] + factor * (wanted[i] - previous[i])
