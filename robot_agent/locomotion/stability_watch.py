"""From margins of stability to what is still allowed: warn, slow down, refuse to walk; with hysteresis.

A body that rests does not tip over. Where its margins say that it should, they are wrong, for instance because a foot
that bears little counts as none; what they lack is then added until they are good by themselves.
"""

from __future__ import annotations

from functools import cache
from math import isfinite

import numpy as np

from weaver_shared.config.locomotion import StabilityConfig
from weaver_shared.robots.gaits import Gait

GOOD, WARN, SLOW, REFUSE = 0, 1, 2, 3
NOTHING = (0.0, 0.0)
LEVELS = ("good", "warn", "slow", "refuse")


class StabilityWatch:
    """A level rises once the margins have been low for `dwell_time` and falls by steps when they have recovered."""

    def __init__(self, config: StabilityConfig, dt: float) -> None:
        self._config = config
        self._dt = dt
        self._static = (config.warn_static, config.slow_static, config.refuse_static)
        self._energy = (config.warn_energy, config.slow_energy, config.refuse_energy)
        self.clear()

    def clear(self) -> None:
        self._level = GOOD
        self._rested = 0.0  # s
        self._missing = NOTHING  # m, of the static and the energy margin of a body that rests
        self._low_for = [0.0, 0.0, 0.0]
        self._good_for = 0.0

    @property
    def idle(self) -> bool:
        """Whether margins above `warn` would change nothing."""
        return self._level == GOOD and self._missing == NOTHING and not any(self._low_for)

    @property
    def calm(self) -> bool:
        """Whether there is nothing to say or do."""
        return self._level == GOOD

    @property
    def level(self) -> str:
        return LEVELS[self._level]

    @property
    def factor(self) -> float:
        """What is left of the wanted velocity."""
        return (1.0, 1.0, self._config.slow_factor, 0.0)[self._level]

    @property
    def reasons(self) -> tuple[str, ...]:
        texts = ("little stability", "little stability: walking slower", "too little stability to walk")
        return (texts[self._level - 1],) if self._level else ()

    def update(self, static: float, energy: float, *, resting: bool = False) -> None:
        """Take this tick's margins, m; `resting`: the body stands, with no foot in the air."""
        if self._level == REFUSE or self._missing != NOTHING:
            static, energy = self._put_right(static, energy, resting)
        if self._level == GOOD and static >= self._static[0] and energy >= self._energy[0]:
            self._low_for[:] = (0.0, 0.0, 0.0)  # the usual case, in short
            return
        for index in range(REFUSE):
            low = not (static >= self._static[index] and energy >= self._energy[index])  # NaN is low
            self._low_for[index] = self._low_for[index] + self._dt if low else 0.0
        wanted = sum(low_for >= self._config.dwell_time for low_for in self._low_for)
        if wanted >= self._level:
            self._level, self._good_for = wanted, 0.0
            return
        self._good_for = self._good_for + self._dt if self._recovered(static, energy) else 0.0
        if self._good_for >= self._config.hold_time:
            self._level, self._good_for = self._level - 1, 0.0

    def _put_right(self, static: float, energy: float, resting: bool) -> tuple[float, float]:
        """The margins with what they lack."""
        if static >= self._static[0] and energy >= self._energy[0]:
            self._missing = NOTHING
        self._rested = self._rested + self._dt if resting and self._level == REFUSE else 0.0
        if self._rested > self._config.rest_time and isfinite(static) and isfinite(energy):
            # Enough to walk slowly.
            self._missing = max(self._static[SLOW - 1] - static, 0.0), max(self._energy[SLOW - 1] - energy, 0.0)
            self._rested = 0.0
        return static + self._missing[0], energy + self._missing[1]

    def _recovered(self, static: float, energy: float) -> bool:
        config, index = self._config, self._level - 1
        return (
            static >= self._static[index] + config.recovery_static
            and energy >= self._energy[index] + config.recovery_energy
        )


@cache
def is_static(gait: Gait) -> bool:
    """Whether at least three feet stand at every moment, so that margins of static stability mean something."""
    phases = np.linspace(0.0, 1.0, 240, endpoint=False)
    standing = ((phases[:, None] + gait.offsets) % 1.0 >= gait.swing - 1e-9).sum(axis=1)
    return bool(standing.min() >= 3)
