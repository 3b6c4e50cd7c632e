"""What the legs feel, seen from the body as it would be without posing: the frame in which walking is planned."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.senses import LegSenses
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


class UnposedSenses:
    """The vectors of `LegSenses` that walking is planned with, turned and moved; the rest is the same."""

    def __init__(self, senses: LegSenses) -> None:
        self._senses = senses
        self.up = np.array([0.0, 0.0, 1.0])
        self.feet = np.zeros_like(senses.feet)
        self.centre_of_mass = np.zeros(3)

    @property
    def force(self) -> Array:
        return self._senses.force

    @property
    def contact(self) -> NDArray[np.bool_]:
        return self._senses.contact

    def update(self, unposed_from_body: Pose) -> None:
        senses, rotation, position = self._senses, unposed_from_body.rotation, unposed_from_body.position
        _move(rotation, position, senses.feet, self.feet)
        _move(rotation, position, senses.centre_of_mass.reshape(1, 3), self.centre_of_mass.reshape(1, 3))
        _move(rotation, np.zeros(3), senses.up.reshape(1, 3), self.up.reshape(1, 3))


@kernel
def _move(rotation: Array, position: Array, points: Array, moved: Array) -> None:
    for i in range(points.shape[0]):
        for k in range(3):
            total = position[k]
            for m in range(3):
                total += rotation[k, m] * points[i, m]
            moved[i, k] = total
