"""A pinhole eye as the graphics card wants it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

NEAR, FAR = 0.03, 150.0  # m


@dataclass(frozen=True, slots=True, kw_only=True)
class Eye:
    """Picture size and intrinsics in pixels (fx, fy, cx, cy; pixel centres at whole numbers)."""

    width: int
    height: int
    intrinsics: tuple[float, float, float, float]

    @property
    def clip_from_optical(self) -> Array:
        """Projection (4, 4) of x right, y down, z forward. Row 0 of the picture comes first in memory."""
        fx, fy, cx, cy = self.intrinsics
        w, h = self.width, self.height
        return np.array(
            [
                [2.0 * fx / w, 0.0, (2.0 * cx + 1.0) / w - 1.0, 0.0],
                [0.0, 2.0 * fy / h, (2.0 * cy + 1.0) / h - 1.0, 0.0],
                [0.0, 0.0, (FAR + NEAR) / (FAR - NEAR), -2.0 * FAR * NEAR / (FAR - NEAR)],
                [0.0, 0.0, 1.0, 0.0],
            ]
        )

    def clip_from_world(self, world_from_optical: Pose) -> Array:
        matrix: Array = self.clip_from_optical @ world_from_optical.inverse().matrix
        return matrix

    def sees(self, world_from_optical: Pose, centres: Array, radius: Array) -> NDArray[np.bool_]:
        """Which spheres (n, 3) of radius (n,) in m reach into the picture."""
        x, y, z = world_from_optical.inverse().transform(centres).T
        fx, fy, _, _ = self.intrinsics
        half_x, half_y = self.width / (2.0 * fx), self.height / (2.0 * fy)
        ahead = z > -radius
        within_x = np.abs(x) - half_x * z < radius * np.hypot(1.0, half_x)
        within_y = np.abs(y) - half_y * z < radius * np.hypot(1.0, half_y)
        seen: NDArray[np.bool_] = ahead & within_x & within_y
        return seen
