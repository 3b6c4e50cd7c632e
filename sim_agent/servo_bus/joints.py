"""What emulated servos turn: simple joints for tests, or those of a simulated robot."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from sim_agent.servo_bus.servo import EmulatedServo

Array = NDArray[np.float64]

STEP_NS = 5_000_000


class FirstOrderJoints:
    """Shafts that close a fixed part of their distance to the goal in each time, no faster than a servo can.

    `load` (A) is what holding still takes; a servo that may not draw that much gives way. A stuck joint stays.
    With `most_steps` time goes in longer steps where a busy computer can not keep up, instead of ever slower.
    """

    def __init__(
        self,
        servos: Sequence[EmulatedServo],
        *,
        start: Array | None = None,
        time_constant: float = 0.03,
        highest_speed: float = 4.7,
        most_steps: int = 1_000_000,
    ) -> None:
        self.servos = servos
        self.position = np.zeros(len(servos)) if start is None else np.array(start, dtype=np.float64)
        self.load = np.zeros(len(servos))
        self.stuck = np.zeros(len(servos), dtype=np.bool_)
        self._time_constant = time_constant
        self._highest_speed = highest_speed
        self._most_steps = most_steps
        self._now_ns: int | None = None
        for servo, position in zip(servos, self.position, strict=True):
            servo.start_at(position)

    def advance(self, now_ns: int) -> None:
        """Move to this time in steps short enough for the servos' watchdogs."""
        if self._now_ns is None:
            self._now_ns = now_ns
        step_ns = max(STEP_NS, (now_ns - self._now_ns) // self._most_steps)
        while self._now_ns < now_ns:
            until_ns = min(self._now_ns + step_ns, now_ns)
            for servo in self.servos:
                servo.elapse(until_ns)
            self._step((until_ns - self._now_ns) * 1e-9)
            self._now_ns = until_ns

    def _step(self, dt: float) -> None:
        orders = [servo.order() for servo in self.servos]
        on = np.array([order.torque_on for order in orders])
        error = np.array([order.position for order in orders]) - self.position
        limit = np.array([order.current_limit for order in orders])
        moved = np.clip(
            error * -np.expm1(-dt / self._time_constant), -self._highest_speed * dt, self._highest_speed * dt
        )
        yields = np.abs(self.load) > limit
        moved = np.where(yields, -np.sign(self.load) * self._highest_speed * dt, moved)
        moved[~on | self.stuck] = 0.0
        pushing = np.where(self.stuck, np.sign(error) * np.minimum(np.abs(error) * 10.0, limit), 0.0)
        current = np.where(on, np.clip(self.load + pushing, -limit, limit), 0.0)
        self.position += moved
        for servo, position, velocity, drawn in zip(self.servos, self.position, moved / dt, current, strict=True):
            servo.feel(position=position, velocity=velocity, current=drawn)
