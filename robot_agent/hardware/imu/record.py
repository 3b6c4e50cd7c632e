"""One inertial sample as a device sends it, and what its values can be."""

from __future__ import annotations

import math
from dataclasses import dataclass

STANDARD_GRAVITY = 9.80665  # m/s^2, what the vendor calls g
HIGHEST_FORCE = 8.0 * STANDARD_GRAVITY  # m/s^2 per axis
HIGHEST_RATE = 9.0  # rad/s per axis: 500 degrees/s and some


@dataclass(frozen=True, slots=True)
class InertialRecord:
    """In the sensor's own axes."""

    device_ns: int  # since the device's clock began, unwrapped
    specific_force: tuple[float, float, float]  # m/s^2
    angular_velocity: tuple[float, float, float]  # rad/s


def possible(force: tuple[float, ...], rate: tuple[float, ...]) -> bool:
    """Whether a sensor of the kind can have measured this."""
    return all(math.isfinite(value) for value in force + rate) and (
        max(map(abs, force)) <= HIGHEST_FORCE and max(map(abs, rate)) <= HIGHEST_RATE
    )
