"""Finds packets in a stream of bytes that may be damaged anywhere."""

from __future__ import annotations

from robot_agent.hardware.servos.checksum import crc16
from robot_agent.hardware.servos.packet import ENVELOPE, HEADER, LONGEST_CONTENT, Frame


class FrameReader:
    """Takes bytes as they come and gives the frames among them whose CRC is right.

    A place that looked like a header and was none costs the search four bytes, never the frames behind it.
    """

    def __init__(self) -> None:
        self._buffer = b""
        self.rejected = 0
        """Headers that no sound frame followed."""

    def feed(self, data: bytes) -> list[Frame]:
        """The frames that these bytes complete."""
        self._buffer += data
        return self._take(waiting=True)

    def finish(self) -> list[Frame]:
        """No more will come: frames behind one that was cut short, and an empty buffer."""
        frames = self._take(waiting=False)
        self._buffer = b""
        return frames

    def _take(self, *, waiting: bool) -> list[Frame]:
        frames = []
        buffer, at = self._buffer, 0
        while True:
            at = buffer.find(HEADER, at)
            if at < 0:
                # The beginning of a header may have come without its end.
                at = max(len(buffer) - len(HEADER) + 1, 0)
                break
            end = _end_of_frame(buffer, at)
            if end is not None and end > len(buffer):
                if waiting:
                    break
                end = None
            if end is not None and crc16(buffer[at : end - 2]) == int.from_bytes(buffer[end - 2 : end], "little"):
                frames.append(Frame(buffer[at + 4], buffer[at + 7 : end - 2]))
                at = end
            else:
                self.rejected += 1
                at += len(HEADER)
        self._buffer = buffer[at:]
        return frames


def _end_of_frame(buffer: bytes, at: int) -> int | None:
    """Where the frame whose header is at `at` ends, perhaps beyond the buffer; None if its length can not be."""
    if len(buffer) < at + 7:
        return at + ENVELOPE + 1
    length = int.from_bytes(buffer[at + 5 : at + 7], "little")
    if not 3 <= length <= LONGEST_CONTENT + 2:
        return None
    return at + 7 + length
