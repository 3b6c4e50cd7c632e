"""How long a recording is and whether it is whole, from the heads of its chunks: nothing is unpacked."""

from __future__ import annotations

import struct
from pathlib import Path

from mcap.opcode import Opcode

MAGIC_BYTES = 8
_HEAD = struct.Struct("<BQ")  # opcode, bytes that follow
_TIMES = struct.Struct("<QQ")  # first and last log time in a chunk


def recorded_span(path: Path) -> tuple[float, bool]:
    """Seconds of the robot's time, and whether the file has its proper end. Raises OSError."""
    first: int | None = None
    last = 0
    size = path.stat().st_size
    with path.open("rb") as stream:
        stream.seek(MAGIC_BYTES)
        while len(head := stream.read(_HEAD.size)) == _HEAD.size:
            opcode, length = _HEAD.unpack(head)
            end = stream.tell() + length
            if end > size:
                break
            if opcode == Opcode.CHUNK and length >= _TIMES.size:
                begin, finish = _TIMES.unpack(stream.read(_TIMES.size))
                first = begin if first is None else min(first, begin)
                last = max(last, finish)
            if opcode == Opcode.FOOTER:
                return _seconds(first, last), True
            stream.seek(end)
    return _seconds(first, last), False


def _seconds(first: int | None, last: int) -> float:
    return 0.0 if first is None else (last - first) * 1e-9
