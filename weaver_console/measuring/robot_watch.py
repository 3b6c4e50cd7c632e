"""Watches over the bus, past the console, how a robot moves: when it was last ordered to, and when it last did."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np

from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.messages import ModeState, RobotState, TruthState

MOVING = 0.02
"""m/s over the time below, from which a body counts as walking; a standing one sways with less."""

SPAN = 0.2


class RobotWatch:
    """Times are s of this computer's monotonic clock, when the robot's word came in."""

    def __init__(self, bus: Bus, robot_id: str) -> None:
        self._lock = threading.Lock()
        self._path: list[tuple[float, float, float]] = []  # when, x, y
        self._ordered = 0.0
        self._moved = 0.0
        self.mode: ModeState | None = None
        bus.subscribe(robot_id, topics.TRUTH, self._see)
        bus.subscribe(robot_id, topics.STATE, self._hear)
        bus.subscribe(robot_id, topics.MODE, self._note)

    @property
    def ordered(self) -> float:
        """When a velocity was last commanded."""
        return self._ordered

    @property
    def moved(self) -> float:
        """When the body was last walking."""
        return self._moved

    @property
    def heard(self) -> float:
        """When the body was last seen at all."""
        with self._lock:
            return self._path[-1][0] if self._path else 0.0

    @property
    def place(self) -> np.ndarray:
        """Where the body is, m, (2,)."""
        with self._lock:
            return np.array(self._path[-1][1:])

    @property
    def speed(self) -> float:
        """m/s over the last second."""
        with self._lock:
            recent = [one for one in self._path if one[0] > self._path[-1][0] - 1.0]
        if len(recent) < 2:
            return 0.0
        (t0, x0, y0), (t1, x1, y1) = recent[0], recent[-1]
        return float(np.hypot(x1 - x0, y1 - y0) / max(t1 - t0, 1e-3))

    def _see(self, _robot: str, _key: str, truth: TruthState) -> None:
        now = time.monotonic()
        x, y, _ = truth.position_in_world.tolist()
        with self._lock:
            self._path = [*(one for one in self._path[-200:] if one[0] > now - 3.0), (now, x, y)]
            before = next((one for one in reversed(self._path) if one[0] <= now - SPAN), None)
        if before is not None and np.hypot(x - before[1], y - before[2]) > MOVING * (now - before[0]):
            self._moved = now

    def _hear(self, _robot: str, _key: str, state: RobotState) -> None:
        if np.any(state.velocity_command):
            self._ordered = time.monotonic()

    def _note(self, _robot: str, _key: str, mode: Any) -> None:
        self.mode = mode
