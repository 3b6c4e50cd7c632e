"""How much the IMU was turned about and pushed along each of its axes, second by second."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.excitation import LEAST_RATE
from weaver_shared.messages import ImuBatch

Array = NDArray[np.float64]

LEAST_PUSH = 0.3
"""m/s^2, root mean square over a second, for that second to count; of turns it is LEAST_RATE.

A robot that sways its body on its feet reaches both; a rig in somebody's hands five times as much.
"""

LEAST = np.repeat([LEAST_RATE, LEAST_PUSH], 3)

LEVELLING = 2.0
"""Time constant with which the mean of what is felt is taken for gravity, s: no push lasts as long."""

LONGEST_GAP = 0.1
"""Between samples, s; after a longer one gravity is looked for anew."""

BIN_NS = 100_000_000
BINS = 10
"""Of a tenth of a second each, in the second that is looked back upon."""


class FeltMotion:
    def __init__(self) -> None:
        self._gravity: Array | None = None  # as the accelerometer feels it at rest, in the IMU's frame
        self._last_ns = 0
        self._bin = -1
        self._squares = np.zeros(7)  # of the bin that fills: turns, pushes, and how many samples
        self._bins: deque[Array] = deque(maxlen=BINS)
        self._seconds = np.zeros(6)

    @property
    def now(self) -> Array:
        """(6,) root mean squares over the last second: turns about x, y, z (rad/s), pushes along them (m/s^2)."""
        total = np.sum(self._bins, axis=0) if self._bins else np.zeros(7)
        return np.asarray(np.sqrt(total[:6] / max(total[6], 1.0)))

    @property
    def seconds(self) -> Array:
        """(6,) for how long each of them was enough."""
        return self._seconds.copy()

    def feel(self, samples: ImuBatch, counts: bool) -> None:
        """`counts`: does it help the calibration, is the target seen meanwhile?"""
        for stamp, turn, force in zip(
            samples.stamp_ns.tolist(), samples.angular_velocity_in_imu, samples.specific_force_in_imu, strict=True
        ):
            push = self._push(stamp, turn, force)
            if push is None:
                continue
            if stamp // BIN_NS != self._bin:
                self._turn_over(stamp // BIN_NS, counts)
            self._squares[:3] += turn * turn
            self._squares[3:6] += push * push
            self._squares[6] += 1.0

    def _push(self, stamp: int, turn: Array, force: Array) -> Array | None:
        """What is felt beyond gravity, which turns in the IMU's frame as the IMU turns; None while it is unknown."""
        step = (stamp - self._last_ns) * 1e-9
        if step <= 0.0 and self._gravity is not None:
            return None
        self._last_ns = stamp
        if self._gravity is None or step > LONGEST_GAP:
            self._gravity = force.copy()
            return None
        self._gravity += step * (np.cross(self._gravity, turn) + (force - self._gravity) / LEVELLING)
        return np.asarray(force - self._gravity)

    def _turn_over(self, number: int, counts: bool) -> None:
        if self._squares[6]:
            self._bins.append(self._squares)
            self._squares = np.zeros(7)
            if counts:
                self._seconds += np.where(self.now >= LEAST, BIN_NS * 1e-9, 0.0)
        self._bin = number
