"""Slips and stumbles: what feet do that nobody asked of them.

Feet on the ground move together, as the body over them does. What one moves beyond that is slip. A foot that is
touched in the middle of its swing has stumbled.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import STAND, SWING
from robot_agent.locomotion.walk_state import LEGS, WalkState
from weaver_shared.config.locomotion import FootingConfig

Array = NDArray[Any]
Flags = NDArray[np.bool_]

EVERY = 4
"""Ticks from one look to the next: slips are slow."""


class Footing:
    """Says once for every slip and stumble which leg it was."""

    def __init__(self, names: tuple[str, ...], state: WalkState, config: FootingConfig, dt: float) -> None:
        self._names = names
        self._memory = state.memory
        dt *= EVERY
        keep = float(np.exp(-dt / config.slip_time))
        self._settings = np.array([dt, keep, config.settle_time, config.slip_distance, *config.stumble_window])
        legs = len(names)
        self._last = np.zeros((legs, 3))
        self._stood = np.zeros(legs)  # s each foot has been on the ground
        self._slipped = np.zeros((legs, 2))  # m, forgotten again over `slip_time`
        self._told = np.zeros((legs, 2), dtype=np.bool_)  # slip, stumble
        self.slipping = state.cut("answer", "slipping").view(np.bool_)  # feet that slide now
        self._ticks = 0

    def clear(self) -> None:
        for array in (self._stood, self._slipped, self._told, self.slipping):
            array[:] = 0

    def step(self) -> tuple[str, ...]:
        """What has happened since the last tick, in words."""
        self._ticks += 1
        if self._ticks % EVERY:
            return ()
        bits = look(self._memory, self._settings, self._last, self._stood, self._slipped, self._told, self.slipping)
        if not bits:
            return ()
        legs = range(len(self._names))
        slips = tuple(f"leg {self._names[leg]} slips" for leg in legs if bits >> leg & 1)
        return slips + tuple(f"leg {self._names[leg]} stumbles" for leg in legs if bits >> (leg + LEGS) & 1)


@kernel
def look(
    memory: Array, settings: Array, last: Array, stood: Array, slipped: Array, told: Flags, slipping: Flags
) -> int:
    """Bits of the legs that slip (from bit 0) and stumble (from bit `LEGS`) and have not been told of yet."""
    walk = memory[0]
    dt, keep, settle_time, slip_distance, first, end = settings
    feet, contact, legs, bits = walk.senses.unposed_feet, walk.senses.contact, walk.model.legs, 0
    standing = np.empty(legs, dtype=np.bool_)
    for leg in range(legs):
        on_ground = walk.feet.mode[leg] == STAND and contact[leg] != 0
        stood[leg] = stood[leg] + dt if on_ground else 0.0
        standing[leg] = stood[leg] > settle_time
    slide(feet[:legs], last, standing, keep, slipped)
    for leg in range(legs):
        last[leg, :] = feet[leg]
        slipping[leg] = np.hypot(slipped[leg, 0], slipped[leg, 1]) > slip_distance
        swinging = walk.feet.mode[leg] == SWING
        progress = walk.gait.leg_phase[leg] / (1.0 - walk.gait.duty)
        stumbling = swinging and contact[leg] != 0 and first < progress < end
        if slipping[leg] and not told[leg, 0]:
            bits |= 1 << leg
        if stumbling and not told[leg, 1]:
            bits |= 1 << (leg + LEGS)
        told[leg, 0] = (told[leg, 0] and walk.feet.mode[leg] == STAND) or slipping[leg]
        told[leg, 1] = (told[leg, 1] and swinging) or stumbling
    return bits


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
