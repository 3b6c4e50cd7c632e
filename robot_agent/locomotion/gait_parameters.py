"""The gait parameters in use: the adaptation's, made finite, bounded and slow enough for a walking robot."""

from __future__ import annotations

from math import isfinite

from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters


class SteadyParameters:
    """Frequency (Hz), swing height (m) and virtual stiffness (N/m), each following its order at a bounded rate."""

    def __init__(self, config: LocomotionConfig, dt: float) -> None:
        self._config = config
        self._dt = dt
        self._started = False
        self.frequency = config.frequency_bounds[1]
        self.height = config.height_bounds[0]
        self.stiffness = config.admittance.stiffness_bounds[1]

    def follow(self, ordered: GaitParameters) -> bool:
        """Take one tick's order; False if a value was not finite, which keeps what was in use."""
        config = self._config
        orders = (ordered.stride_frequency, ordered.stride_height, ordered.virtual_stiffness)
        usable = all(isfinite(value) for value in orders)
        frequency = _bounded(orders[0], self.frequency, config.frequency_bounds)
        height = _bounded(orders[1], self.height, config.height_bounds)
        stiffness = _bounded(orders[2], self.stiffness, config.admittance.stiffness_bounds)
        if not self._started:
            self.frequency, self.height, self.stiffness = frequency, height, stiffness
            self._started = usable
            return usable
        self.frequency += _clip(frequency - self.frequency, config.frequency_rate * self._dt)
        self.height += _clip(height - self.height, config.height_rate * self._dt)
        self.stiffness += _clip(stiffness - self.stiffness, config.stiffness_rate * self._dt)
        return usable


def _bounded(value: float, otherwise: float, bounds: tuple[float, float]) -> float:
    return min(max(value, bounds[0]), bounds[1]) if isfinite(value) else otherwise


def _clip(value: float, size: float) -> float:
    return min(max(value, -size), size)
