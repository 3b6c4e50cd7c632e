"""Slips and stumbles: what feet do that nobody asked of them.

Feet on the ground move together, as the body over them does. What one moves beyond that is slip. A foot that is
touched in the middle of its swing has stumbled.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import STAND, SWING
from robot_agent.locomotion.walk_state import WalkState
from weaver_shared.config.locomotion import FootingConfig

Array = NDArray[np.float64]

EVERY = 4
"""Ticks from one look to the next: slips are slow, and a look costs a tenth of a tick."""


class Footing:
    """Says once for every slip and stumble which leg it was."""

    def __init__(self, names: tuple[str, ...], state: WalkState, config: FootingConfig, dt: float) -> None:
        self._names = names
        self._config = config
        self._dt = dt * EVERY
        self._feet, self._contact = state.cut("senses", "unposed_feet"), state.cut("senses", "contact")
        self._mode, self._phase = state.cut("feet", "mode"), state.cut("gait", "leg_phase")
        self._gait = state.record["gait"]
        legs = len(names)
        self._last = np.zeros((legs, 3))
        self._stood = np.zeros(legs)  # s each foot has been on the ground
        self._slipped = np.zeros((legs, 2))  # m, forgotten again over `slip_time`
        self._told_slip = np.zeros(legs, dtype=np.bool_)
        self._told_stumble = np.zeros(legs, dtype=np.bool_)
        self._ticks = 0

    def clear(self) -> None:
        self._stood[:] = 0.0
        self._slipped[:] = 0.0
        self._told_slip[:] = False
        self._told_stumble[:] = False

    @property
    def slipping(self) -> NDArray[np.bool_]:
        """Legs (legs,) whose feet slide now."""
        return np.hypot(self._slipped[:, 0], self._slipped[:, 1]) > self._config.slip_distance

    def step(self) -> tuple[str, ...]:
        """What has happened since the last tick, in words."""
        self._ticks += 1
        if self._ticks % EVERY:
            return ()
        self._watch_standing()
        return (*self._slips(), *self._stumbles())

    def _watch_standing(self) -> None:
        config = self._config
        keep = np.exp(-self._dt / config.slip_time)
        standing = (self._mode == STAND) & (self._contact != 0)
        self._stood = np.where(standing, self._stood + self._dt, 0.0)
        slide(self._feet, self._last, self._stood > config.settle_time, float(keep), self._slipped)
        self._last[:] = self._feet

    def _slips(self) -> tuple[str, ...]:
        fresh = self.slipping & ~self._told_slip
        self._told_slip = (self._told_slip & (self._mode == STAND)) | fresh
        return tuple(f"leg {self._names[leg]} slips" for leg in np.flatnonzero(fresh))

    def _stumbles(self) -> tuple[str, ...]:
        progress = self._phase / (1.0 - float(self._gait["duty"]))
        first, last = self._config.stumble_window
        swinging = self._mode == SWING
        met = swinging & (self._contact != 0) & (progress > first) & (progress < last)
        fresh = met & ~self._told_stumble
        self._told_stumble = (self._told_stumble & swinging) | fresh
        return tuple(f"leg {self._names[leg]} stumbles" for leg in np.flatnonzero(fresh))


@kernel
def slide(feet: Array, before: Array, standing: NDArray[np.bool_], keep: float, slipped: Array) -> None:
    """Add to `slipped` (legs, 2) what each standing foot moved beyond the turn and shift that fit all of them best.

    `feet` and `before` (legs, 3) are in body, m; `keep` is what is left of earlier slip.
    """
    n, mx, my, bx, by = 0, 0.0, 0.0, 0.0, 0.0
    for leg in range(feet.shape[0]):
        if standing[leg]:
            n += 1
            mx, my = mx + feet[leg, 0], my + feet[leg, 1]
            bx, by = bx + before[leg, 0], by + before[leg, 1]
    for leg in range(feet.shape[0]):
        if not standing[leg]:
            slipped[leg, 0], slipped[leg, 1] = 0.0, 0.0
    if n < 3:
        return
    mx, my, bx, by = mx / n, my / n, bx / n, by / n
    cross, dot = 0.0, 0.0
    for leg in range(feet.shape[0]):
        if standing[leg]:
            x, y = before[leg, 0] - bx, before[leg, 1] - by
            u, v = feet[leg, 0] - mx, feet[leg, 1] - my
            cross += x * v - y * u
            dot += x * u + y * v
    turn = np.arctan2(cross, dot)
    c, s = np.cos(turn), np.sin(turn)
    for leg in range(feet.shape[0]):
        if standing[leg]:
            x, y = before[leg, 0] - bx, before[leg, 1] - by
            slipped[leg, 0] = keep * slipped[leg, 0] + feet[leg, 0] - mx - c * x + s * y
            slipped[leg, 1] = keep * slipped[leg, 1] + feet[leg, 1] - my - s * x - c * y
