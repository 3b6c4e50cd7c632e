"""One OpenSHC leg: forward kinematics and its damped step of inverse kinematics a tick (facts 3.13)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import solve_symmetric
from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.openshc import configuration

Array = NDArray[np.float64]

DAMPING = 0.02**2
TOLERANCE = 0.005
"""m, an axis' tip error beyond which the step is said to have failed."""
LIMIT_WEIGHT = 0.1
POSITION_SHARE, RATE_SHARE = 0.25, 0.75


class Leg:
    """State of one chain: joint angles and rates as last ordered. Row 0 of `dh` (n + 1, 4) is the fixed base."""

    def __init__(
        self,
        description: configuration.Leg,
        dt: float,
        *,
        clamp_rate: bool,
        clamp_position: bool = True,
        start: Array | None = None,
    ) -> None:
        self.description = description
        self._dh, self._limits, self._dt = description.dh, description.limits, dt
        self._largest_rates = np.array([joint.max_vel for joint in description.joints])
        self._clamp_rate, self._clamp_position = clamp_rate, clamp_position
        self.position = self.rest() if start is None else np.array(start, dtype=np.float64)
        self.rate = np.zeros(self.position.size)

    def rest(self) -> Array:
        """Angles without any command: zero, or the limit nearest to it."""
        angles: Array = np.clip(0.0, self._limits[:, 0], self._limits[:, 1])
        return angles

    def simulated(self) -> Leg:
        """A copy to search with: at rest, its rates free."""
        return Leg(self.description, self._dt, clamp_rate=False, start=self.position)

    def tip_frame(self) -> Array:
        """Frame of the tip in body, (4, 4)."""
        frame = np.eye(4)
        _tip_frame(self._dh, self.position, frame)
        return frame

    def tip(self) -> Array:
        tip: Array = self.tip_frame()[:3, 3]
        return tip

    def step_to(self, wanted_tip: Array, direction: Array | None = None) -> float:
        """One step towards `wanted_tip` (3,) in body, and the tip's x axis towards `direction` (3,) if given.

        Returns how near the nearest joint limit is, over half its range; 0 when the tip is missed. A direction that
        can not be had is given up, and another step taken without it.
        """
        if direction is None:
            return self._move(wanted_tip, clamp_rate=self._clamp_rate)
        error = _turn_between(self.tip_frame()[:3, 0], direction)
        self._move(wanted_tip, clamp_rate=False)
        nearest = self._turn(error, wanted_tip)
        return nearest if nearest > 0.0 else self._move(wanted_tip, clamp_rate=self._clamp_rate)

    def _move(self, wanted_tip: Array, *, clamp_rate: bool) -> float:
        rates = np.where(clamp_rate, self._largest_rates, np.inf)
        return _step(
            self._dh,
            self._limits,
            self._largest_rates,
            rates,
            self._clamp_position,
            self._dt,
            wanted_tip,
            self.position,
            self.rate,
        )

    def _turn(self, error: Array, wanted_tip: Array) -> float:
        """The second step, of rotation alone; `error` (3,) is from before the first (D16)."""
        n = self.position.size
        jacobian, descent = np.zeros((6, n)), np.zeros(n)
        _jacobian(self._dh, self.position, jacobian)
        _descent(self._limits, self._largest_rates, self.position, self.rate, descent)
        inverse = jacobian.T @ np.linalg.inv(jacobian @ jacobian.T + DAMPING * np.eye(6))
        wanted = np.concatenate([np.zeros(3), error])
        step = inverse @ wanted + (np.eye(n) - inverse @ jacobian) @ descent
        rates = np.where(self._clamp_rate, self._largest_rates, np.inf)
        _apply(self._limits, rates, self._clamp_position, self._dt, step, self.position, self.rate)
        return _nearness(self._dh, self._limits, self.position, wanted_tip)


def _turn_between(here: Array, there: Array) -> Array:
    """Rotation vector (3,) that turns one direction into another."""
    axis = np.cross(here, there)
    sine = float(np.linalg.norm(axis))
    if sine == 0.0:
        return np.zeros(3)
    turn: Array = axis / sine * np.arctan2(sine, float(here @ there))
    return turn


@kernel
def _tip_frame(dh: Array, position: Array, frame: Array) -> None:
    """Multiply `frame` (4, 4) by the whole chain."""
    for row in range(dh.shape[0]):
        _along(dh, row, position[row - 1] if row else 0.0, frame)


@kernel
def _along(dh: Array, row: int, angle: float, frame: Array) -> None:
    """Multiply `frame` by RotZ(theta + angle) TransZ(d) TransX(r) RotX(alpha)."""
    c, s = np.cos(dh[row, 0] + angle), np.sin(dh[row, 0] + angle)
    ca, sa = np.cos(dh[row, 3]), np.sin(dh[row, 3])
    d, r = dh[row, 1], dh[row, 2]
    for i in range(3):
        x, y, z = frame[i, 0], frame[i, 1], frame[i, 2]
        frame[i, 3] += x * (r * c) + y * (r * s) + z * d
        frame[i, 0] = x * c + y * s
        turned = y * c - x * s
        frame[i, 1] = turned * ca + z * sa
        frame[i, 2] = z * ca - turned * sa


@kernel
def _jacobian(dh: Array, position: Array, jacobian: Array) -> None:
    """Fill rows 0-2 with the tip's velocity and rows 3-5 with its rotation, (6, n), in body."""
    n = position.size
    frame = np.eye(4)
    _along(dh, 0, 0.0, frame)
    origins = np.empty((n, 3))
    for i in range(n):
        for a in range(3):
            jacobian[3 + a, i], origins[i, a] = frame[a, 2], frame[a, 3]
        _along(dh, i + 1, position[i], frame)
    for i in range(n):
        x, y, z = jacobian[3, i], jacobian[4, i], jacobian[5, i]
        ax, ay, az = frame[0, 3] - origins[i, 0], frame[1, 3] - origins[i, 1], frame[2, 3] - origins[i, 2]
        jacobian[0, i] = y * az - z * ay
        jacobian[1, i] = z * ax - x * az
        jacobian[2, i] = x * ay - y * ax


@kernel
def _step(
    dh: Array,
    limits: Array,
    largest_rates: Array,
    rate_bounds: Array,
    clamp_position: bool,
    dt: float,
    wanted_tip: Array,
    position: Array,
    rate: Array,
) -> float:
    """dq = J+ dx + (I - J+ J) g, J+ = J^T (J J^T + damping)^-1; `position` and `rate` (n,) change in place."""
    n = position.size
    jacobian, descent, frame = np.empty((6, n)), np.zeros(n), np.eye(4)
    _jacobian(dh, position, jacobian)
    _descent(limits, largest_rates, position, rate, descent)
    _tip_frame(dh, position, frame)
    normal, error, along = np.empty((3, 3)), np.empty(3), np.zeros(3)
    for a in range(3):
        error[a] = wanted_tip[a] - frame[a, 3]
        for i in range(n):
            error[a] -= jacobian[a, i] * descent[i]
        for b in range(3):
            normal[a, b] = DAMPING if a == b else 0.0
            for i in range(n):
                normal[a, b] += jacobian[a, i] * jacobian[b, i]
    solve_symmetric(normal, error, along)
    for i in range(n):
        for a in range(3):
            descent[i] += jacobian[a, i] * along[a]
    _apply(limits, rate_bounds, clamp_position, dt, descent, position, rate)
    return _nearness(dh, limits, position, wanted_tip)


@kernel
def _apply(
    limits: Array, rate_bounds: Array, clamp_position: bool, dt: float, step: Array, position: Array, rate: Array
) -> None:
    """Each rate is clamped by itself, so the tip leaves its line (D15)."""
    for i in range(position.size):
        rate[i] = min(max(step[i] / dt, -rate_bounds[i]), rate_bounds[i])
        position[i] += rate[i] * dt
        if clamp_position:
            position[i] = min(max(position[i], limits[i, 0]), limits[i, 1])


@kernel
def _nearness(dh: Array, limits: Array, position: Array, wanted_tip: Array) -> float:
    frame, nearest = np.eye(4), 1.0
    _tip_frame(dh, position, frame)
    for i in range(position.size):
        half = 0.5 * (limits[i, 1] - limits[i, 0])
        if half != 0.0:
            nearest = min(nearest, min(abs(position[i] - limits[i, 0]), abs(limits[i, 1] - position[i])) / half)
    for a in range(3):
        if abs(wanted_tip[a] - frame[a, 3]) > TOLERANCE:
            return 0.0
    return nearest


@kernel
def _descent(limits: Array, largest_rates: Array, position: Array, rate: Array, descent: Array) -> None:
    """Away from joint limits and from large rates. Of constant size, so it chatters at rest (D7)."""
    extent = limits[:, 1] - limits[:, 0]
    _descend(position - 0.5 * (limits[:, 0] + limits[:, 1]), extent, POSITION_SHARE, descent)
    _descend(rate, 2.0 * largest_rates, RATE_SHARE, descent)


@kernel
def _descend(value: Array, extent: Array, share: float, descent: Array) -> None:
    """Add `share` of the descent direction of |w v / R|: -w^2 v / R^2 / |w v / R|."""
    cost = 0.0
    for i in range(value.size):
        if extent[i] != 0.0:
            cost += (LIMIT_WEIGHT * value[i] / extent[i]) ** 2
    cost = np.sqrt(cost)
    if cost > 0.0:
        for i in range(value.size):
            if extent[i] != 0.0:
                descent[i] -= share * LIMIT_WEIGHT**2 * value[i] / extent[i] ** 2 / cost
