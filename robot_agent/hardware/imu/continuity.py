"""Believes records whose device time goes on from the last one; a jump of that clock needs a second witness.

The checks at the end of the vendor's records are weak against lost bytes (a sum of 67 bytes fits by chance once in
10 000 times); a time that goes on by less than a second fits by chance once in 70 000 times more.
"""

from __future__ import annotations

from robot_agent.hardware.imu.record import InertialRecord

LONGEST_GAP_NS = 1_000_000_000


class Continuity:
    def __init__(self) -> None:
        self._last_ns: int | None = None
        self._waiting: InertialRecord | None = None
        self.jumps = 0
        """How often the device's clock began anew."""

    def accept(self, record: InertialRecord) -> list[InertialRecord]:
        """The records that may be believed now: this one, none, or this one and the one before."""
        if self._last_ns is not None and _follows(self._last_ns, record):
            self._waiting = None
            self._last_ns = record.device_ns
            return [record]
        witness, self._waiting = self._waiting, record
        if witness is None or not _follows(witness.device_ns, record):
            return []
        self.jumps += self._last_ns is not None
        self._waiting, self._last_ns = None, record.device_ns
        return [witness, record]


def _follows(before_ns: int, record: InertialRecord) -> bool:
    return 0 < record.device_ns - before_ns <= LONGEST_GAP_NS
