"""An IMU heard by a thread of its own, at once: 3 ms of delay would cost the odometry a tenth of the way's length.

The control loop listens a hundred times a second, and the least delay that it ever sees is that of a phase between two
clocks, which stays for minutes.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from robot_agent.hardware.serial_line import SerialLine
from robot_agent.hardware.sources import InertialSource
from weaver_shared.messages import ImuBatch

PATIENCE = 0.1  # s without a byte after which the source is asked all the same: it wakes a silent device
MOST_WAITING = 200
"""Batches kept for a control loop that stands still."""


class PunctualImu:
    """An `InertialSource` that asks `source` whenever `line`, on which it listens, has something to read."""

    def __init__(self, source: InertialSource, line: SerialLine, now_ns: Callable[[], int]) -> None:
        self._source = source
        self._line = line
        self._now_ns = now_ns
        self._taken: list[ImuBatch] = []
        self._guard = threading.Lock()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._listen, name="imu", daemon=True)
        self._thread.start()

    def take(self, now_ns: int) -> ImuBatch:
        with self._guard:
            taken, self._taken = self._taken, []
        return ImuBatch.join(taken)

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._source.close()

    def _listen(self) -> None:
        while not self._ending.is_set():
            self._line.wait(PATIENCE)
            batch = self._source.take(self._now_ns())
            if batch.stamp_ns.size:
                with self._guard:
                    self._taken = [*self._taken[-MOST_WAITING:], batch]
