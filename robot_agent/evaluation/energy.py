"""Cost of transport (ICRA'17 eq. 12): energy over weight and distance, for the whole supply and for motors alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.frames import GRAVITY


@dataclass(frozen=True, slots=True, kw_only=True)
class CostOfTransport:
    """Dimensionless; NaN when nothing was travelled. `total` as in Weaver's paper, `motors` as in OpenSHC's."""

    total: float
    motors: float


def cost_of_transport(
    *,
    supply_power: NDArray[np.float64],
    motor_power: NDArray[np.float64],
    dt: float,
    distance: float,
    mass: float,
) -> CostOfTransport:
    """Mean power (W, one sample each `dt` s) over m g v with v the mean speed of `distance` m."""
    if not distance > 0.0 or supply_power.size == 0:
        return CostOfTransport(total=float("nan"), motors=float("nan"))
    work = mass * GRAVITY * distance
    return CostOfTransport(total=float(supply_power.sum() * dt / work), motors=float(motor_power.sum() * dt / work))
