"""Gathers the answers of many servos to one sync read: whoever answered soundly counts, whoever did not is marked.

The SDK's group read gives up at the first servo that is missing and forgets the servos' error bytes.
"""

from __future__ import annotations

from operator import eq

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.servos.checksum import crc16_of_rows
from robot_agent.hardware.servos.frame_reader import FrameReader
from robot_agent.hardware.servos.packet import ENVELOPE, HEADER, STATUS_OVERHEAD, Frame, Instruction, Status, status_of

LONGEST_SLIP = 3
"""Bytes lost or added in one place; with more the answer fails for its length."""
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
            fits = status is not None and status.id in self._rank and len(status.parameters) == self.length
            if status is not None and fits and not self._slipped(frame):
                self._keep(status, again=status.id in seen)
                seen.add(status.id)
        self.rejected += reader.rejected

    def _slipped(self, frame: Frame) -> bool:
        """Whether bytes were lost or added inside this answer: one in 65 536 of such has a CRC that fits by chance.

        The header of the answer that follows tells, even when that one is damaged itself.
        """
        end = frame.end
        # Cut short, it goes on with the next answer; stuffing keeps headers out of a sound one.
        if HEADER in self._bytes[end - len(frame.content) : end]:
            return True
        following = self._bytes.find(HEADER, end)
        gap = self._bytes[end : following if following >= 0 else None]
        answer = STATUS_OVERHEAD + self.length
        too_many, too_few = len(gap) % answer, -len(gap) % answer
        if 0 < too_few <= LONGEST_SLIP:
            # Lost here, and taken from the next one's header; or lost there.
            return self._bytes[end - too_few : end] == HEADER[:too_few]
        if 0 < too_many <= LONGEST_SLIP and not HEADER.startswith(gap):
            # Added here, and the end of this one is left over; or added there, behind the first byte of a header.
            start = end - len(frame.content) - ENVELOPE
            begun = len(gap) > answer and gap[0] == HEADER[0]
            return not begun and self._likeness(start, end + too_many) > self._likeness(start, end)
        return False

    def _likeness(self, start: int, other: int) -> int:
        """How many of an answer's first bytes, at `start`, are the same at another place."""
        size = self._beginnings.shape[1]
        return sum(map(eq, self._bytes[start : start + size], self._bytes[other : other + size]))

    def _keep(self, status: Status, *, again: bool) -> None:
        rank = self._rank[status.id]
        # Two answers under one id are two servos with that id: neither can be believed.
        self.valid[rank] = not again
        self.error[rank] = status.error
        self.data[rank] = np.frombuffer(status.parameters, dtype=np.uint8)
