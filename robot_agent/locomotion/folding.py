"""Legs without load moving through postures: all at once, or one group of every second leg after the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.rising import Glide

Array = NDArray[np.float64]


class Folding:
    """Joint angles (legs, n) from where they are through `postures`, at a bounded mean joint speed in rad/s."""

    def __init__(self, start: Array, postures: Sequence[Array], speed: float, *, in_groups: bool) -> None:
        self._glides: list[Glide] = []
        here = start.copy()
        groups = (
            [np.arange(len(start)) % 2 == group for group in range(2)] if in_groups else [np.full(len(start), True)]
        )
        for group in groups:
            for posture in postures:
                there = np.where(group[:, None], posture, here)
                if (there != here).any():
                    self._glides.append(Glide(here, there, speed))
                here = there
        self._last = here

    @property
    def done(self) -> bool:
        return not self._glides

    def step(self, dt: float) -> Array:
        """Angles a tick of `dt` s later."""
        if not self._glides:
            return self._last
        angles = self._glides[0].step(dt)
        if self._glides[0].done:
            self._glides.pop(0)
        return angles
