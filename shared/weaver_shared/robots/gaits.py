"""Gaits as timing: which fraction of a stride a foot stands, and when each leg's stride begins (OpenSHC'20 IV-B1)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SWING_OF_TURN = 0.8
"""Of a leg's turn in the air; in the rest all feet stand, for a foot lands some 50 ms later than it is told to, and
the next must not lift before it carries: three feet left of a wave are a triangle with the mass at its edge."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Gait:
    """`offset` is added to the common phase; a leg swings while its own phase is below 1 - duty."""

    name: str
    duty: float  # stance time over stride time
    offset: tuple[float, ...]  # legs, fraction of a stride

    @property
    def swing(self) -> float:
        return 1.0 - self.duty

    @property
    def offsets(self) -> NDArray[np.float64]:
        return np.array(self.offset)

    @property
    def fewest_standing(self) -> int:
        """Feet on the ground when most are in the air."""
        lifts = (1.0 - self.offsets) % 1.0  # common phase at which each leg lifts; most swing just after a lift
        phases = (lifts[:, None] + self.offsets + 1e-9) % 1.0
        return int((phases >= self.swing - 1e-6).sum(axis=1).min())


def _gait(name: str, duty: float, parts: int, order: Iterable[int]) -> Gait:
    """Offsets as whole `parts` of a stride, in leg order."""
    return Gait(name=name, duty=duty, offset=tuple(n / parts for n in order))


def _wave(legs: int) -> Gait:
    """One foot at a time, each side from back to front: AR, then the left side, then the rest of the right."""
    half = legs // 2
    backwards = [0, *range(half, legs), *range(half - 1, 0, -1)] if legs % 2 == 0 else list(range(legs))
    offset = [0.0] * legs
    for turn, leg in enumerate(backwards):
        offset[leg] = (-turn / legs) % 1.0
    # Four feet or fewer: a foot in the air leaves no reserve, so swings are quicker still.
    duty = 1.0 - (SWING_OF_TURN if legs > 4 else 0.6) / legs
    return Gait(name="wave", duty=duty, offset=tuple(offset))


_HEXAPOD = (
    # Swing order AR+CR+BL, BR+CL+AL. Duty above one half: both tripods stand while the load changes over.
    _gait("tripod", 0.56, 2, (0, 1, 0, 1, 0, 1)),
    # AR, CL, BR, AL, CR, BL, each beginning half a turn after the one before.
    _gait("ripple", 1.0 - SWING_OF_TURN / 3.0, 6, (0, 4, 2, 5, 1, 3)),
    # Pairs AR+CL, CR+AL, BR+BL.
    _gait("amble", 1.0 - SWING_OF_TURN / 3.0, 6, (0, 2, 4, 0, 2, 4)),
    # Pairs AR+CL, BR+BL, CR+AL; mostly two feet on the ground, so it does not stand still anywhere in the stride.
    _gait("bipod", 0.40, 6, (0, 4, 2, 0, 4, 2)),
)

_QUADRUPED = (
    # Diagonal pairs AR+BL and BR+AL, with a moment on all four feet between them.
    _gait("trot", 0.60, 2, (0, 1, 0, 1)),
)

_OCTOPOD = (
    # Every second leg around the body: AR+CR+DL+BL, BR+DR+CL+AL.
    _gait("tetrapod", 0.56, 2, (0, 1, 0, 1, 0, 1, 0, 1)),
    # Two in the air, each swing beginning half a turn after the one before: AR, CL, BR, BL, CR, AL, DR, DL.
    _gait("ripple", 1.0 - SWING_OF_TURN / 4.0, 8, (0, 6, 4, 2, 1, 7, 5, 3)),
    # Pairs AR+DL, BR+CL, CR+BL, DR+AL.
    _gait("amble", 1.0 - SWING_OF_TURN / 4.0, 4, (0, 1, 2, 3, 0, 1, 2, 3)),
)

_BY_LEGS = {4: _QUADRUPED, 6: _HEXAPOD, 8: _OCTOPOD}


def predefined_gaits(legs: int) -> dict[str, Gait]:
    """Gaits by name for a robot of that many legs, the fastest first; legs are in clockwise order from the front right.

    Every number of legs has a wave; those of four, six and eight legs have the usual faster ones.
    """
    gaits = [*_BY_LEGS.get(legs, ()), _wave(legs)]
    return {gait.name: gait for gait in gaits}
