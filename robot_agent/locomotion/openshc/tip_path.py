"""One foot over one OpenSHC step: three quartic Bezier curves integrated by their derivative (facts 3.7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.bezier import quartic_derivative
from robot_agent.locomotion.openshc.step_cycle import StepCycle, even_up

Array = NDArray[np.float64]

SWING, STANCE, FORCE_STANCE, FORCE_STOP = range(4)


class TipPath:
    """Tip of one leg over the ground (walk plane), m."""

    def __init__(self, default: Array, swing_height: float, dt: float) -> None:
        self.default = default.copy()
        self.tip = default.copy()
        self.velocity = np.zeros(3)
        self.stride = np.zeros(3)
        self.target = default.copy()
        self._swing_height = swing_height
        self._dt = dt
        self._swing_origin = default.copy()
        self._lift_off_velocity = np.zeros(3)
        self._stance_origin = default.copy()

    def aim(self, linear: Array, angular: float, cycle: StepCycle) -> None:
        """Stride for the body's velocity, re-computed every tick from where the tip is; the target lags a tick."""
        self.target = self.default + 0.5 * self.stride
        ratio = cycle.on_ground_ratio / cycle.frequency
        self.stride = ratio * np.array([linear[0] - angular * self.tip[1], linear[1] + angular * self.tip[0], 0.0])

    def swing(self, tick: int, cycle: StepCycle) -> None:
        """Tick 1, 2, ... of the swing."""
        if tick == 1:
            self._swing_origin = self.tip.copy()
            self._lift_off_velocity = self.velocity.copy()
        ticks = even_up(int((cycle.swing_period / cycle.period) / (cycle.frequency * self._dt)))
        half, step = ticks // 2, 1.0 / (ticks // 2)
        first, second = self._nodes(step, cycle)
        if tick <= half:
            self._advance(first, step, step * tick)
        else:
            self._advance(second, step, step * (tick - half))

    def stand(self, tick: int, first_tick: int, cycle: StepCycle) -> None:
        """Tick 1, 2, ... of a stance that begins at phase `first_tick`."""
        if tick == 1:
            self._stance_origin = self.tip.copy()
        length = (cycle.stance_end - first_tick) % cycle.period or cycle.period
        share = length / cycle.stance_period
        step = 1.0 / int((length / cycle.period) / (cycle.frequency * self._dt))
        nodes = self._stance_origin - 0.25 * share * np.arange(5)[:, None] * self.stride
        self._advance(nodes, step, tick * step)

    def _nodes(self, step: float, cycle: StepCycle) -> tuple[Array, Array]:
        apex = 0.5 * (self._swing_origin + self.target)
        apex[2] = max(self._swing_origin[2], self.target[2]) + self._swing_height
        leaving = 0.25 * self._lift_off_velocity * (self._dt / step)
        stance_step = 1.0 / int((cycle.stance_period / cycle.period) / (cycle.frequency * self._dt))
        arriving = 0.25 * (-self.stride * stance_step / self._dt) * (self._dt / step)
        first = np.array([self._swing_origin + i * leaving for i in range(3)] + [apex, apex])
        first[3] = 0.5 * (apex + first[2])
        first[3, 2] = apex[2]
        second = np.array([apex, 2.0 * apex - first[3], *(self.target - i * arriving for i in (2, 1, 0))])
        return first, second

    def _advance(self, nodes: Array, step: float, t: float) -> None:
        slope = np.empty(3)
        quartic_derivative(nodes, t, slope)
        change = step * slope
        self.tip = self.tip + change
        self.velocity = change / self._dt
