"""A virtual mass on a spring at every foot, as OpenSHC integrates it: one state for three axes (facts 3.12, D5)."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.settings import Settings
from robot_agent.locomotion.openshc.step_path import StepPath
from robot_agent.locomotion.openshc.steps import MANUAL, SWING

Array = NDArray[np.float64]

PARTS = 30
LARGEST_OFFSET = 0.2


class Admittance:
    """`offsets` (legs, 3) m to add to the feet; `stiffness` (legs,) is reported, but never used (D3)."""

    def __init__(self, settings: Settings, legs: int) -> None:
        self._settings = settings
        self.state = np.zeros((legs, 2))
        self.offsets = np.zeros((legs, 3))
        self.stiffness = np.zeros(legs)

    def update(self, forces: Array, tip_directions: Array) -> None:
        """`forces` (legs, 3) N felt at the feet; `tip_directions` (legs, 3), along which alone a foot gives way."""
        settings = self._settings
        mass, stiffness = settings.virtual_mass, settings.virtual_stiffness
        damping = 2.0 * settings.virtual_damping_ratio * sqrt(mass * stiffness)
        step = settings.description.integrator_step_time / PARTS
        moves = _runge_kutta(np.array([[0.0, 1.0], [-stiffness / mass, -damping / mass]]), step)
        for leg, force in enumerate(forces):
            offset = np.zeros(3)
            for axis in range(3):
                push = np.array([0.0, -max(float(force[axis]) * settings.force_gain, 0.0) / mass])
                for _ in range(PARTS):
                    self.state[leg] = moves[0] @ self.state[leg] + moves[1] @ push
                offset[axis] = min(max(-self.state[leg, 0], -LARGEST_OFFSET), LARGEST_OFFSET)
            self.offsets[leg] = float(offset @ tip_directions[leg]) * tip_directions[leg]

    def report_stiffness(self, paths: Sequence[StepPath]) -> None:
        """Less for a swinging leg and more for its neighbours, by how high it is."""
        description, base = self._settings.description, self._settings.virtual_stiffness
        self.stiffness[:] = base
        for leg, path in enumerate(paths):
            if path.step_state != SWING:
                continue
            share = abs(float(path.tip[2] - path.default[2]) / self._settings.swing_height)
            self.stiffness[leg] = base * (share * (description.swing_stiffness_scaler - 1.0) + 1.0)
            for neighbour in ((leg - 1) % len(paths), (leg + 1) % len(paths)):
                self.stiffness[neighbour] += base * share * (description.load_stiffness_scaler - 1.0)

    def report_transition(self, leg: int, share: float, leg_states: Sequence[int]) -> None:
        """While `leg` is lifted for manipulation, `share` from 0 to 1, or put down again."""
        description, base = self._settings.description, self._settings.virtual_stiffness
        self.stiffness[leg] = base * (share * (description.swing_stiffness_scaler - 1.0) + 1.0)
        for neighbour in ((leg - 1) % len(leg_states), (leg + 1) % len(leg_states)):
            if leg_states[neighbour] != MANUAL:
                self.stiffness[neighbour] = base * (share * (description.load_stiffness_scaler - 1.0) + 1.0)


def _runge_kutta(a: Array, h: float) -> tuple[Array, Array]:
    """What one classical step of x' = A x + b does: x := first x + second b."""
    one, ha = np.eye(2), h * a
    first = one + ha @ (one + ha @ (one / 2 + ha @ (one / 6 + ha / 24)))
    second = h * (one + ha @ (one / 2 + ha @ (one / 6 + ha / 24)))
    return first, second
