"""Every corner of every view in one table, as the kernels take it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.sightings import View
from robot_agent.calibration.target import Target

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class CornerTable:
    """One row per corner seen: which view and eye, where on the target (m), where in the picture (px)."""

    view: NDArray[np.int64]  # (n,), ascending
    eye: NDArray[np.int64]  # (n,)
    point: Array  # (n, 3)
    pixel: Array  # (n, 2)

    @staticmethod
    def of(views: Sequence[View], target: Target, eyes: Sequence[int]) -> CornerTable:
        """The corners seen by `eyes`, which are numbered anew from 0 in the order given."""
        points = target.points
        parts = [
            (number, k, points[sighting.corners], sighting.pixels)
            for number, view in enumerate(views)
            for k, eye in enumerate(eyes)
            if (sighting := view.eyes[eye]) is not None
        ]
        counts = [len(pixels) for _, _, _, pixels in parts]
        return CornerTable(
            view=np.repeat(np.array([part[0] for part in parts], dtype=np.int64), counts),
            eye=np.repeat(np.array([part[1] for part in parts], dtype=np.int64), counts),
            point=np.concatenate([part[2] for part in parts]),
            pixel=np.concatenate([part[3] for part in parts]),
        )

    def __len__(self) -> int:
        return len(self.view)

    def only(self, kept: NDArray[np.bool_]) -> CornerTable:
        return CornerTable(view=self.view[kept], eye=self.eye[kept], point=self.point[kept], pixel=self.pixel[kept])
