"""One OpenSHC leg: forward kinematics and its single damped step of inverse kinematics a tick (facts 3.13)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import leg_frames, solve_symmetric
from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]

DAMPING = 0.02**2
TOLERANCE = 0.005
"""m, an axis' tip error beyond which the step is said to have failed."""
LIMIT_WEIGHT = 0.1
POSITION_SHARE, RATE_SHARE = 0.25, 0.75


class Leg:
    """State of one chain: joint angles and rates as last ordered. Row 0 of `dh` (n + 1, 4) is the fixed base."""

    def __init__(self, dh: Array, limits: Array, max_rate: float, clamp_rate: bool, dt: float, start: Array) -> None:
        self._dh, self._limits, self._dt = dh, limits, dt
        self._max_rate, self._clamp_rate = max_rate, clamp_rate
        self.position = start.copy()
        self.rate = np.zeros(start.size)

    def copy(self, *, clamp_rate: bool) -> Leg:
        twin = Leg(self._dh, self._limits, self._max_rate, clamp_rate, self._dt, self.position)
        twin.rate = self.rate.copy()
        return twin

    def tip_frame(self) -> Array:
        """Frame of the tip in body, (4, 4)."""
        frame = np.eye(4)
        for (theta, d, r, alpha), angle in zip(self._dh, [0.0, *self.position], strict=True):
            c, s = np.cos(theta + angle), np.sin(theta + angle)
            ca, sa = np.cos(alpha), np.sin(alpha)
            frame = frame @ np.array(
                [[c, -s * ca, s * sa, r * c], [s, c * ca, -c * sa, r * s], [0.0, sa, ca, d], [0.0, 0.0, 0.0, 1.0]]
            )
        return frame

    def tip(self) -> Array:
        tip: Array = self.tip_frame()[:3, 3]
        return tip

    def step_to(self, wanted_tip: Array) -> float:
        """One step towards `wanted_tip` (3,) in body.

        Returns how near the nearest joint limit is, over half its range; 0 when the tip is missed.
        """
        return _step(
            self._dh, self._limits, self._max_rate, self._clamp_rate, self._dt, wanted_tip, self.position, self.rate
        )


@kernel
def _step(
    dh: Array,
    limits: Array,
    max_rate: float,
    clamp_rate: bool,
    dt: float,
    wanted_tip: Array,
    position: Array,
    rate: Array,
) -> float:
    """dq = J+ dx + (I - J+ J) g, J+ = J^T (J J^T + damping)^-1; `position` and `rate` (n,) change in place."""
    n = position.size
    angles, hip = np.zeros(n + 1), np.zeros(3)
    origins, axes = np.empty((n + 2, 3)), np.empty((n + 1, 3))
    angles[1:] = position
    leg_frames(dh, hip, np.eye(3), angles, origins, axes)
    jacobian, descent = np.empty((3, n)), np.zeros(n)
    for i in range(n):
        arm, axis = origins[n + 1] - origins[i + 1], axes[i + 1]
        jacobian[0, i] = axis[1] * arm[2] - axis[2] * arm[1]
        jacobian[1, i] = axis[2] * arm[0] - axis[0] * arm[2]
        jacobian[2, i] = axis[0] * arm[1] - axis[1] * arm[0]
    extent = limits[:, 1] - limits[:, 0]
    _descend(position - 0.5 * (limits[:, 0] + limits[:, 1]), extent, POSITION_SHARE, descent)
    _descend(rate, np.full(n, 2.0 * max_rate), RATE_SHARE, descent)
    normal, error, along = np.empty((3, 3)), np.empty(3), np.zeros(3)
    for a in range(3):
        error[a] = wanted_tip[a] - origins[n + 1, a]
        for i in range(n):
            error[a] -= jacobian[a, i] * descent[i]
        for b in range(3):
            normal[a, b] = DAMPING if a == b else 0.0
            for i in range(n):
                normal[a, b] += jacobian[a, i] * jacobian[b, i]
    solve_symmetric(normal, error, along)
    for i in range(n):
        step = descent[i] + jacobian[0, i] * along[0] + jacobian[1, i] * along[1] + jacobian[2, i] * along[2]
        rate[i] = step / dt
        if clamp_rate:
            rate[i] = min(max(rate[i], -max_rate), max_rate)
        position[i] = min(max(position[i] + rate[i] * dt, limits[i, 0]), limits[i, 1])
    angles[1:] = position
    leg_frames(dh, hip, np.eye(3), angles, origins, axes)
    nearest = 1.0
    for i in range(n):
        nearest = min(nearest, min(position[i] - limits[i, 0], limits[i, 1] - position[i]) / (0.5 * extent[i]))
    for a in range(3):
        if abs(wanted_tip[a] - origins[n + 1, a]) > TOLERANCE:
            return 0.0
    return nearest


@kernel
def _descend(value: Array, extent: Array, share: float, descent: Array) -> None:
    """Add `share` of the descent direction of |w v / R|: -w^2 v / R^2 / |w v / R|."""
    cost = 0.0
    for i in range(value.size):
        cost += (LIMIT_WEIGHT * value[i] / extent[i]) ** 2
    cost = np.sqrt(cost)
    if cost > 0.0:
        for i in range(value.size):
            descent[i] -= share * LIMIT_WEIGHT**2 * value[i] / extent[i] ** 2 / cost
