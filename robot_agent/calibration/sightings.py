"""What was seen of a target: numbered corners in the pictures of one instant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, kw_only=True)
class Sighting:
    """Corners of the target in one picture; the numbers index the target's points."""

    corners: NDArray[np.int64]  # (n,), each once
    pixels: Array  # (n, 2)

    def __len__(self) -> int:
        return len(self.corners)


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """One instant: what each eye saw, None where it saw no target."""

    stamp_ns: int
    eyes: tuple[Sighting | None, ...]
    name: str = ""  # of the picture, for messages

    @property
    def seen(self) -> int:
        """Corners in all eyes together."""
        return sum(len(eye) for eye in self.eyes if eye is not None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """All views of a recording; `sizes` are width and height of each eye's pictures, px."""

    views: tuple[View, ...]
    sizes: tuple[tuple[int, int], ...]
    pictures: int  # looked at, with or without a target in them

    @property
    def eyes(self) -> int:
        return len(self.sizes)

    def seen_by(self, eye: int) -> tuple[View, ...]:
        return tuple(view for view in self.views if view.eyes[eye] is not None)
