"""The solver's step in extended precision, for the search of the standing joints (facts 3.13).

Near rest the null-space motion has a constant size whatever its cause, so the start-up amplifies rounding by 1e9. In
double precision two correct programs end 3e-7 rad apart; here only OpenSHC's own rounding is left.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.leg import Leg

Extended = np.longdouble
Array = NDArray[Any]
"""Of `Extended`: 64 bits of mantissa on x86, as good as double elsewhere."""

DAMPING = Extended(0.02) ** 2
LIMIT_WEIGHT = Extended(0.1)
POSITION_SHARE, RATE_SHARE = Extended(0.25), Extended(0.75)


class ExtendedLegs:
    """Legs of equally many joints, at rest: `position` and `rate` (legs, n)."""

    def __init__(self, legs: Sequence[Leg], dt: float) -> None:
        self._dh = np.array([leg.description.dh for leg in legs], dtype=Extended)
        limits = np.array([leg.description.limits for leg in legs], dtype=Extended)
        self._lower, self._upper = limits[..., 0], limits[..., 1]
        self._rates = np.array([[joint.max_vel for joint in leg.description.joints] for leg in legs], dtype=Extended)
        self._dt = Extended(dt)
        self.position = np.array([leg.rest() for leg in legs], dtype=Extended)
        self.rate = np.zeros_like(self.position)

    def tips(self) -> Array:
        return self._chain()[0]

    def step_to(self, wanted_tips: Array) -> None:
        """One step of every leg towards `wanted_tips` (legs, 3) in body, rates free."""
        tips, jacobian = self._chain()
        centre, extent = (self._lower + self._upper) / 2, self._upper - self._lower
        descent = POSITION_SHARE * _descent(self.position - centre, extent)
        descent += RATE_SHARE * _descent(self.rate, 2 * self._rates)
        normal = (jacobian[:, :, None, :] * jacobian[:, None, :, :]).sum(axis=-1) + DAMPING * np.eye(3, dtype=Extended)
        error = wanted_tips - tips - (jacobian * descent[:, None, :]).sum(axis=-1)
        step = descent + (jacobian * _solved(normal, error)[:, :, None]).sum(axis=1)
        self.rate = step / self._dt
        self.position = np.minimum(np.maximum(self.position + self.rate * self._dt, self._lower), self._upper)

    def _chain(self) -> tuple[Array, Array]:
        """Tips (legs, 3) and their Jacobian (legs, 3, n)."""
        count, joints = self.position.shape
        x, y, z = (np.tile(row, (count, 1)) for row in np.eye(3, dtype=Extended))
        here = np.zeros((count, 3), dtype=Extended)
        origins, axes = [], []
        for row in range(joints + 1):
            theta, d, r, alpha = (self._dh[:, row, k, None] for k in range(4))
            if row:
                origins.append(here)
                axes.append(z)
                theta = theta + self.position[:, row - 1, None]
            ahead = np.cos(theta) * x + np.sin(theta) * y
            aside = np.cos(theta) * y - np.sin(theta) * x
            here = here + d * z + r * ahead
            x, y, z = ahead, np.cos(alpha) * aside + np.sin(alpha) * z, np.cos(alpha) * z - np.sin(alpha) * aside
        columns = [np.cross(axis, here - origin) for axis, origin in zip(axes, origins, strict=True)]
        return here, np.stack(columns, axis=-1)


def _descent(value: Array, extent: Array) -> Array:
    """Of |w v / R|, one row a leg; zero where that is zero."""
    scaled = np.divide(LIMIT_WEIGHT * value, extent, out=np.zeros_like(value), where=extent != 0)
    size = np.sqrt((scaled * scaled).sum(axis=-1, keepdims=True))
    slope = np.divide(-LIMIT_WEIGHT * scaled, extent, out=np.zeros_like(value), where=extent != 0)
    descent: Array = np.divide(slope, size, out=np.zeros_like(value), where=size > 0)
    return descent


def _solved(matrix: Array, right: Array) -> Array:
    """x of the symmetric `matrix` (legs, 3, 3) x = `right` (legs, 3), by cross products."""
    a, b, c = (matrix[:, :, k] for k in range(3))
    ab, bc, ca = np.cross(a, b), np.cross(b, c), np.cross(c, a)
    determinant = (a * bc).sum(axis=-1)
    solved: Array = np.stack([(right * side).sum(axis=-1) for side in (bc, ca, ab)], -1) / determinant[:, None]
    return solved
