"""What an operator wants of the body's pose."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.locomotion import PosingConfig

AXES = ("x", "y", "z", "roll", "pitch", "yaw")


@dataclass(frozen=True, slots=True, kw_only=True)
class PosingOrder:
    """`manual` holds x, y, z (m) and roll, pitch, yaw (rad) of the body against its un-posed place."""

    manual: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    automatic: bool = False  # moves with the gait
    levelling: bool = False  # keeps the body level, or at the manual roll and pitch, by the IMU

    @property
    def idle(self) -> bool:
        return not (self.automatic or self.levelling or any(self.manual))


NO_POSING = PosingOrder()


def bounded(manual: tuple[float, ...], config: PosingConfig) -> NDArray[np.float64]:
    """The manual pose (6,) within the box of what may be asked; what is not a number asks for nothing."""
    limits = np.array([*config.largest_position, *config.largest_rotation])
    wanted = np.array([value if isfinite(value) else 0.0 for value in manual])
    result: NDArray[np.float64] = np.clip(wanted, -limits, limits)
    return result
