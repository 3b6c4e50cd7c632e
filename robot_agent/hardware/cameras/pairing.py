"""Which picture of the one eye belongs to which of the other: told by their counters, checked by their stamps."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

MOST_WAITING = 8
"""Pictures of an eye that may wait for the other's; an eye that has died must not fill the memory."""
SURE = 3
"""Pairs in a row whose stamps fit, after which the counters' difference is known."""


class Eye(IntEnum):
    LEFT = 0
    RIGHT = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """As an eye has taken it; both stamps on the robot's clock."""

    counter: int
    stamp_ns: int  # mid-exposure
    pixels: NDArray[np.uint8]  # (height, width)


@dataclass(slots=True)
class PairCounts:
    """Of pictures since the beginning."""

    paired: int = 0
    single: int = 0  # whose other eye's never came
    apart: int = 0  # with the right counter and a stamp that can not be


class Pairing:
    """Two eyes exposed at once count alike but for a constant difference, which the first stamps tell.

    `period` is that of the exposures, s. A pair is given when both its pictures are there, older ones are left behind.
    """

    def __init__(self, period: float, *, range_of_counter: int = 65_535) -> None:
        self._tolerance_ns = round(0.5e9 * period)
        self._range = range_of_counter
        self._waiting: tuple[list[Picture], list[Picture]] = ([], [])
        self._difference: int | None = None
        self._fitting = 0
        self.counts = PairCounts()

    def add(self, eye: Eye, picture: Picture) -> tuple[Picture, Picture] | None:
        """The pair (left, right) that this picture completes, if it does."""
        mine, others = self._waiting[eye], self._waiting[1 - eye]
        mine.append(picture)
        if len(mine) > MOST_WAITING:
            del mine[0]
            self.counts.single += 1
        for place, other in enumerate(others):
            left, right = (picture, other) if eye is Eye.LEFT else (other, picture)
            if self._belong(left, right):
                self.counts.single += place + len(mine) - 1
                del others[: place + 1]
                mine.clear()
                self.counts.paired += 1
                return left, right
        return None

    def _belong(self, left: Picture, right: Picture) -> bool:
        difference = (right.counter - left.counter) % self._range
        together = abs(right.stamp_ns - left.stamp_ns) < self._tolerance_ns
        if self._fitting < SURE:
            if together:
                self._fitting = self._fitting + 1 if difference == self._difference else 1
                self._difference = difference
            return together
        if difference == self._difference and not together:
            # One of the counters or clocks has begun anew: what is known of them holds no longer.
            self.counts.apart += 1
            self._fitting = 0
        return difference == self._difference and together
