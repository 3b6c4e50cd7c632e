"""Gathers the answers of many servos to one sync read: whoever answered soundly counts, whoever did not is marked.

The SDK's group read gives up at the first servo that is missing and forgets the servos' error bytes. Sound is what has
the form asked for and a CRC that fits; what a CRC can not tell, the values do (`health_block`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.servos.checksum import crc16_of_rows
from robot_agent.hardware.servos.frame_reader import FrameReader
from robot_agent.hardware.servos.packet import ALERT, HEADER, STATUS_OVERHEAD, Instruction, Status, status_of

_PAYLOAD = 9
"""Where parameters begin in a status packet."""


class GroupAnswer:
    """Answers with `length` bytes of data each of the servos `ids`, in the order in which they are asked."""

    def __init__(self, ids: list[int], length: int) -> None:
        self.ids = ids
        self.length = length
        self._rank = {servo: rank for rank, servo in enumerate(ids)}
        # How a sound answer without stuffing begins: header, id, length, instruction.
        beginning = [HEADER + bytes([servo]) + (length + 4).to_bytes(2, "little") + b"\x55" for servo in ids]
        self._beginnings = np.frombuffer(b"".join(beginning), dtype=np.uint8).reshape(len(ids), 8)
        self.data = np.zeros((len(ids), length), dtype=np.uint8)
        self.error = np.zeros(len(ids), dtype=np.uint8)
        self.valid = np.zeros(len(ids), dtype=np.bool_)
        self.rejected = 0
        """Answers that were damaged, since the beginning of time."""
        self._bytes = b""
        self._all = len(ids) * (STATUS_OVERHEAD + length)

    def begin(self) -> None:
        """A new question is on its way: nobody has answered."""
        self._bytes = b""
        self.valid[:] = False

    def feed(self, data: bytes) -> None:
        self._bytes += data

    @property
    def complete(self) -> bool:
        """Whether as many bytes have come as all servos send; stuffing only makes them more."""
        return len(self._bytes) >= self._all

    def finish(self) -> NDArray[np.bool_]:
        """Fill `data`, `error` and `valid` (n,) from what came; returns `valid`."""
        if not self.ids:
            return self.valid
        if len(self._bytes) != self._all or not self._take_all_at_once():
            self._take_one_by_one()
        return self.valid

    def _take_all_at_once(self) -> bool:
        """The usual case, everybody in order and nothing stuffed; False if it is not that."""
        rows = np.frombuffer(self._bytes, dtype=np.uint8).reshape(len(self.ids), -1)
        printed = rows[:, -2] | rows[:, -1].astype(np.uint16) << 8
        if (rows[:, :8] != self._beginnings).any() or (crc16_of_rows(rows[:, :-2]) != printed).any():
            return False
        if (rows[:, _PAYLOAD - 1] & (0xFF ^ ALERT)).any():
            return False
        self.error[:] = rows[:, _PAYLOAD - 1]
        self.data[:] = rows[:, _PAYLOAD:-2]
        self.valid[:] = True
        return True

    def _take_one_by_one(self) -> None:
        reader = FrameReader()
        frames = reader.feed(self._bytes) + reader.finish()
        seen: set[int] = set()
        for frame in frames:
            status = status_of(frame) if frame.instruction == Instruction.STATUS else None
            if status is not None and self._fits(status):
                self._keep(status, again=status.id in seen)
                seen.add(status.id)
        self.rejected += reader.rejected

    def _fits(self, status: Status) -> bool:
        """Whether it is what was asked for; a servo that finds a fault in the question has no data to send."""
        return status.id in self._rank and len(status.parameters) == self.length and not status.error & ~ALERT

    def _keep(self, status: Status, *, again: bool) -> None:
        rank = self._rank[status.id]
        # Two answers under one id are two servos with that id: neither can be believed.
        self.valid[rank] = not again
        self.error[rank] = status.error
        self.data[rank] = np.frombuffer(status.parameters, dtype=np.uint8)
