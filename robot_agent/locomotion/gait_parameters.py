"""The gait parameters in use: the adaptation's, made finite, bounded and slow enough for a walking robot."""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.reasons import PARAMETER
from robot_agent.locomotion.walk_state import Array, Record


@kernel
def follow_parameters(walk: Record) -> None:
    """Frequency (Hz), swing height (m) and virtual stiffness (N/m) follow their order at a bounded rate.

    The first usable order is taken as it is. One that is not finite keeps what was in use. No swing of the chosen gait
    becomes shorter than the settings say.
    """
    gait, settings, orders, dt = walk.gait, walk.settings, walk.orders.parameters, walk.model.dt
    frequency = _bounded(orders[0], gait.frequency, settings.frequency_bounds)
    frequency = min(frequency, (1.0 - walk.orders.duty) / settings.shortest_swing)
    height = _bounded(orders[1], gait.height, settings.height_bounds)
    stiffness = _bounded(orders[2], gait.stiffness, settings.admittance.stiffness_bounds)
    usable = np.isfinite(orders[0]) and np.isfinite(orders[1]) and np.isfinite(orders[2])
    if not usable:
        walk.answer.reasons |= PARAMETER
    if not gait.started:
        gait.frequency, gait.height, gait.stiffness = frequency, height, stiffness
        gait.started = usable
        return
    gait.frequency += _clip(frequency - gait.frequency, settings.frequency_rate * dt)
    gait.height += _clip(height - gait.height, settings.height_rate * dt)
    gait.stiffness += _clip(stiffness - gait.stiffness, settings.stiffness_rate * dt)


@kernel
def _bounded(value: float, otherwise: float, bounds: Array) -> float:
    return min(max(value, bounds[0]), bounds[1]) if np.isfinite(value) else otherwise


@kernel
def _clip(value: float, size: float) -> float:
    return min(max(value, -size), size)
