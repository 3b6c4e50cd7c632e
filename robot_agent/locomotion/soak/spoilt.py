"""Numbers as a broken wire or a careless sender gives them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BAD = np.array([np.nan, np.inf, -np.inf, 1e300, -1e12, 0.0])
FAULTS = 0.02
"""Chance, a tick, that a reading is at fault."""


def spoilt(rng: np.random.Generator, values: Array, *, chance: float = FAULTS) -> Array:
    """The values, or now and then a copy with one or all of them replaced; readings also of the wrong size."""
    if rng.random() >= chance:
        return values
    kind, copy = rng.integers(8), values.copy()
    if kind == 0:
        copy[:] = rng.choice(BAD)
    elif kind == 1 and chance == FAULTS:
        return copy[:-1]
    else:
        copy[rng.integers(values.size)] = rng.choice(BAD)
    return copy
