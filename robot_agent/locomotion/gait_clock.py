"""The gait's phase as an exact float: frequency and gait may change under way without a jump."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.gaits import Gait

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
        self._glide = glide

    @property
    def swing(self) -> float:
        """Fraction of a stride that a leg swings."""
        return 1.0 - self.duty

    @property
    def leg_phase(self) -> Array:
        """Phase of every leg, (legs,), 0 at lift-off."""
        result: Array = (self.phase + self._offset) % 1.0
        return result

    def choose(self, gait: Gait) -> None:
        self.gait = gait

    def restart(self, phase: float) -> None:
        """Begin anew at a common phase, with the chosen gait's offsets."""
        self.phase = phase % 1.0
        self.duty = self.gait.duty
        self._offset = self.gait.offsets

    def advance(self, strides: float) -> None:
        """Move on by a number of strides, frequency times dt."""
        self.phase = (self.phase + strides) % 1.0
        gap = (self.gait.offsets - self._offset + 0.5) % 1.0 - 0.5
        self._offset = (self._offset + np.clip(gap, -self._glide * strides, self._glide * strides)) % 1.0
        self.duty += float(np.clip(self.gait.duty - self.duty, -self._glide * strides, self._glide * strides))
