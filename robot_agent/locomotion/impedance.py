"""All legs' impedance: how far each foot gives way to the force it feels beyond its share of the weight (eq. 6)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.admittance import damping_of, step_admittance, transition
from weaver_shared.config.locomotion import AdmittanceConfig

Array = NDArray[np.float64]


class LegImpedance:
    """Offsets along gravity, (legs, 2): m upwards and m/s."""

    def __init__(self, legs: int, config: AdmittanceConfig, dt: float) -> None:
        self._config = config
        self._dt = dt
        self._step = np.zeros((2, 3))
        self._stiffness = 0.0
        self.offset = np.zeros((legs, 2))

    def clear(self) -> None:
        self.offset[:] = 0.0

    def step(self, surplus: Array, stiffness: float) -> None:
        """One tick under `surplus` (legs,) N, force felt less force expected, with `stiffness` N/m."""
        config = self._config
        if stiffness != self._stiffness:
            mass = config.virtual_mass
            damping = damping_of(mass, config.damping_ratio, stiffness, config.smallest_damping)
            transition(mass, damping, stiffness, self._dt, self._step)
            self._stiffness = stiffness
        step_admittance(self.offset, surplus, self._step, config.largest_force, config.largest_offset)
