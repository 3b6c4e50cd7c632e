"""The gait's phase as an exact float: frequency and gait may change under way without a jump."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from weaver_shared.robots.gaits import Gait

Array = NDArray[np.float64]


class GaitClock:
    """Common phase 0..1 plus one offset a leg. Offsets glide to those of a newly chosen gait.

    A leg's phase only ever runs forwards, and its offset glides by at most `glide` strides per stride, so a gait
    change neither repeats nor skips part of a stride.
    """

    def __init__(self, gait: Gait, *, glide: float = 0.25) -> None:
        self.gait = gait
        self.phase = 0.0
        self.duty = gait.duty
        self._offset = gait.offsets
        self._goal = gait.offsets
        self._glide = glide
        self.leg_phase = self._offset.copy()  # (legs,), 0 at lift-off

    @property
    def swing(self) -> float:
        """Fraction of a stride that a leg swings."""
        return 1.0 - self.duty

    def choose(self, gait: Gait) -> None:
        if gait is not self.gait:
            self.gait, self._goal = gait, gait.offsets

    def restart(self, phase: float) -> None:
        """Begin anew at a common phase, with the chosen gait's offsets."""
        self.phase = phase % 1.0
        self.duty = self.gait.duty
        self._offset = self._goal.copy()
        self.leg_phase = (self.phase + self._offset) % 1.0

    def advance(self, strides: float) -> None:
        """Move on by a number of strides, frequency times dt."""
        self.phase = (self.phase + strides) % 1.0
        self.leg_phase = np.empty_like(self._offset)
        _glide_offsets(self._offset, self._goal, self._glide * strides, self.phase, self.leg_phase)
        step = self._glide * strides
        self.duty += min(max(self.gait.duty - self.duty, -step), step)


@kernel
def _glide_offsets(offset: Array, goal: Array, largest: float, phase: float, leg_phase: Array) -> None:
    for leg in range(offset.size):
        gap = (goal[leg] - offset[leg] + 0.5) % 1.0 - 0.5
        offset[leg] = (offset[leg] + min(max(gap, -largest), largest)) % 1.0
        leg_phase[leg] = (phase + offset[leg]) % 1.0
