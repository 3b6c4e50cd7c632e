"""The rectified left eye at the resolution pictures are matched at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.vision.rectification import Rectifier
from weaver_shared.transforms import Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkingCamera:
    """Rows of both eyes are parallel; a point at depth Z has disparity `focal_length * baseline / Z` px."""

    width: int
    height: int
    focal_length: float  # px
    cx: float
    cy: float
    baseline: float  # m
    body_from_camera: Pose  # left eye, optical frame

    @staticmethod
    def of(rectifier: Rectifier) -> WorkingCamera:
        return WorkingCamera(
            width=rectifier.width,
            height=rectifier.height,
            focal_length=rectifier.fx,
            cx=rectifier.cx,
            cy=rectifier.cy,
            baseline=rectifier.baseline,
            body_from_camera=rectifier.body_from_rectified,
        )

    def ray_slopes(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """x/Z of every column (width,) and y/Z of every row (height,)."""
        columns = (np.arange(self.width, dtype=np.float64) - self.cx) / self.focal_length
        rows = (np.arange(self.height, dtype=np.float64) - self.cy) / self.focal_length
        return columns, rows
