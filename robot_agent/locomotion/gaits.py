"""Gaits as timing: which fraction of a stride a foot stands, and when each leg's stride begins (OpenSHC'20)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import ConfigurationError


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


def _sixths(*order: int) -> tuple[float, ...]:
    return tuple(n / 6.0 for n in order)


GAITS = {
    gait.name: gait
    for gait in (
        # Swing order AR+CR+BL, BR+CL+AL. Duty above one half: both tripods stand while the load changes over.
        Gait(name="tripod", duty=0.56, offset=(0.0, 0.5, 0.0, 0.5, 0.0, 0.5)),
        # AR, CL, BR, AL, CR, BL, each beginning half a swing after the one before.
        Gait(name="ripple", duty=2.0 / 3.0, offset=_sixths(0, 4, 2, 5, 1, 3)),
        # Pairs AR+CL, CR+AL, BR+BL.
        Gait(name="amble", duty=2.0 / 3.0, offset=_sixths(0, 2, 4, 0, 2, 4)),
        # One foot at a time: AR, CL, BL, AL, CR, BR.
        Gait(name="wave", duty=5.0 / 6.0, offset=_sixths(0, 1, 2, 5, 4, 3)),
    )
}


def gait_of(name: str) -> Gait:
    """Raises ConfigurationError that names the valid gaits."""
    if name not in GAITS:
        raise ConfigurationError(f"gait {name!r} is unknown; known are {', '.join(GAITS)}")
    return GAITS[name]
