"""3DM-GX3-25, single-byte protocol: records of fixed length that echo the command and end in a sum of bytes.

Everything is big-endian (3DM-GX3 Data Communications Protocol, commands 0xC8, 0xC4, 0xFA, 0xDB).
"""

from __future__ import annotations

import struct

from robot_agent.hardware.imu.continuity import Continuity
from robot_agent.hardware.imu.record import STANDARD_GRAVITY, InertialRecord, possible

MOTION = 0xC8
"""Command of acceleration (3) in g, angular rate (3) in rad/s, orientation matrix (9), timer."""
LENGTH = 67
STOP = bytes.fromhex("FA75B4")
TICKS_PER_SECOND = 62_500
TIMER_RANGE = 1 << 32
"""Ticks after which the timer begins anew: 19 h."""
ORTHONORMAL = 0.02
"""How far rows of a rotation may be from unit length and right angles in single precision."""

_RECORD = struct.Struct(">B3f3f9fIH")


def start_streaming() -> bytes:
    """Continuous mode for `MOTION`; the device answers with 8 bytes and then sends by itself."""
    return bytes([0xC4, 0xC1, 0x29, MOTION])


def sampling(rate: int) -> bytes:
    """Sampling settings for `rate` Hz, which must divide 1000: data conditioning on, filters as from the factory."""
    return bytes.fromhex("DBA8B901") + struct.pack(">HHBBHHB5x", 1000 // rate, 0x0003, 15, 17, 10, 10, 0)


def sum_of(data: bytes) -> int:
    return sum(data) & 0xFFFF


class Gx3Parser:
    """Turns the device's bytes into records; replies to commands and damage between them are passed over."""

    def __init__(self) -> None:
        self._buffer = b""
        self._continuity = Continuity()
        self._timer = 0
        """Ticks of the last believed record, unwrapped."""

    @property
    def jumps(self) -> int:
        return self._continuity.jumps

    def feed(self, data: bytes) -> list[InertialRecord]:
        buffer, at, records = self._buffer + data, 0, []
        while (at := buffer.find(MOTION, at)) >= 0 and len(buffer) - at >= LENGTH:
            raw = buffer[at : at + LENGTH]
            record = self._read(raw)
            if record is None:
                at += 1
                continue
            if believed := self._continuity.accept(record):
                records += believed
                self._timer = record.device_ns * TICKS_PER_SECOND // 1_000_000_000
            at += LENGTH
        self._buffer = buffer[at:] if at >= 0 else b""
        return records

    def _read(self, raw: bytes) -> InertialRecord | None:
        if sum_of(raw[:-2]) != int.from_bytes(raw[-2:], "big"):
            return None
        _, *values, timer, _ = _RECORD.unpack(raw)
        force, rate, matrix = values[:3], tuple(values[3:6]), values[6:]
        specific_force = tuple(value * STANDARD_GRAVITY for value in force)
        if not possible(specific_force, rate) or not _is_rotation(matrix):
            return None
        return InertialRecord(
            self._unwrapped_ns(timer),
            (specific_force[0], specific_force[1], specific_force[2]),
            (rate[0], rate[1], rate[2]),
        )

    def _unwrapped_ns(self, timer: int) -> int:
        """Time of a timer that begins anew every 19 h: it goes on from the last believed one."""
        laps, last = divmod(self._timer, TIMER_RANGE)
        ticks = (laps + (last - timer > TIMER_RANGE // 2)) * TIMER_RANGE + timer
        # Rounded up, so that the ticks come back from it.
        return -(-ticks * 1_000_000_000 // TICKS_PER_SECOND)


def _is_rotation(matrix: list[float]) -> bool:
    """Whether nine numbers, row by row, are near a rotation: a check on more than half of the record's bytes."""
    if not all(abs(value) <= 1.0 + ORTHONORMAL for value in matrix):
        return False
    rows = matrix[:3], matrix[3:6], matrix[6:]
    return all(
        abs(sum(a * b for a, b in zip(rows[i], rows[j], strict=True)) - (i == j)) < ORTHONORMAL
        for i in range(3)
        for j in range(i, 3)
    )
