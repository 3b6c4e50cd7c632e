"""What the front end hands to the back end for one frame."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Tracks(NamedTuple):
    """Features followed into this frame, by the number each got when it was found."""

    identity: NDArray[np.int64]  # (n,)
    observation: NDArray[np.float64]  # (n, 2, 2) eye, undistorted x and y on the plane z = 1
    seen: NDArray[np.uint8]  # (n,) bits 1 left, 2 right
    flow: float  # px, median motion since the previous frame; NaN without features that were followed
    problem: str  # what is wrong with the pictures; empty if nothing

    @staticmethod
    def none(problem: str) -> Tracks:
        return Tracks(
            identity=np.zeros(0, dtype=np.int64),
            observation=np.zeros((0, 2, 2)),
            seen=np.zeros(0, dtype=np.uint8),
            flow=float("nan"),
            problem=problem,
        )

    @property
    def number(self) -> int:
        return len(self.identity)
