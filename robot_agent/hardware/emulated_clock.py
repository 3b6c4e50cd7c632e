"""The time of an emulated robot: real time, that stands still whenever the computer can not keep up with its physics.

The emulator writes it to a file that both map into memory; see `sim_agent.twin.twin_time`.
"""

from __future__ import annotations

import mmap
import select
import struct
import time
from collections.abc import Sequence
from pathlib import Path

from robot_agent.hardware.servos.port import SerialPort, ServoPort
from weaver_shared.errors import ResourceError

LAYOUT = struct.Struct("<QqqQ")
"""Count of writings, time of the last tick, monotonic time at which it ended (ns), the count again."""
COUNT = 8  # bytes of each count
TICK_NS = 10_000_000
STANDSTILL_NS = 20_000_000_000
LEAST_NAP = 2e-4  # s


class EmulatedClock:
    """A `robot_agent.hardware.servos.port.LineClock` on an emulator's file.

    Raises ResourceError where there is no such file, or where time has stood still for 20 s.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            with path.open("rb") as file:
                self._map = mmap.mmap(file.fileno(), LAYOUT.size, access=mmap.ACCESS_READ)
        except (OSError, ValueError) as error:
            raise ResourceError(f"no emulated robot keeps its time in {path}; start `weaver twin run` first") from error

    def now_ns(self) -> int:
        ended_ns, at_ns = self._last_tick()
        return ended_ns + min(time.monotonic_ns() - at_ns, TICK_NS)

    def sleep_until(self, stamp_ns: int) -> None:
        while (remaining := stamp_ns - self.now_ns()) > 0:
            self._still_there()
            time.sleep(max(remaining * 1e-9, LEAST_NAP))

    def wait_for_answer(self, ports: Sequence[ServoPort], deadline_ns: int) -> None:
        remaining = deadline_ns - self.now_ns()
        if remaining > 0:
            self._still_there()
            select.select([port for port in ports if isinstance(port, SerialPort)], [], [], remaining * 1e-9)

    def _last_tick(self) -> tuple[int, int]:
        while True:
            # Against the order in which it is written.
            after = self._map[-COUNT:]
            _, ended_ns, at_ns, _ = LAYOUT.unpack_from(self._map)
            if self._map[:COUNT] == after:
                return ended_ns, at_ns

    def _still_there(self) -> None:
        if time.monotonic_ns() - self._last_tick()[1] > STANDSTILL_NS:
            raise ResourceError(f"the emulated robot that keeps its time in {self._path} stands still")
