"""Where in a recording each message stands, so that any moment of it can be gone to at once.

Read from the indexes behind the file's chunks: nothing is unpacked but what says which channel is which key, and a
last chunk whose index a crash cut off.
"""

from __future__ import annotations

import struct
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BufferedReader, BytesIO
from pathlib import Path

import numpy as np
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Schema
from mcap.stream_reader import breakup_chunk, get_chunk_data_stream
from numpy.typing import NDArray

from robot_agent.recording.reader import DAMAGE
from weaver_shared.errors import InputError

MAGIC_BYTES = 8
CHUNKS_KEPT = 8
"""Unpacked ones: those of the newest values of many keys lie close together."""

_HEAD = struct.Struct("<BQ")  # opcode, bytes that follow
_INDEX_HEAD = struct.Struct("<HI")  # channel, bytes of its entries
_MESSAGE_HEAD = struct.Struct("<BQHIQQ")  # opcode, length, channel, sequence, log time, publish time
_ENTRY = np.dtype([("time", "<u8"), ("offset", "<u8")])

Ints = NDArray[np.int64]


@dataclass(slots=True)
class _Gathered:
    """Entries of the chunks read so far, a piece of each channel in each chunk."""

    times: list[Ints] = field(default_factory=list)
    offsets: list[Ints] = field(default_factory=list)
    chunks: list[Ints] = field(default_factory=list)
    channels: list[Ints] = field(default_factory=list)

    def add(self, entries: NDArray[np.void], chunk: int, channel: int) -> None:
        self.times.append(entries["time"].astype(np.int64))
        self.offsets.append(entries["offset"].astype(np.int64))
        self.chunks.append(np.full(len(entries), chunk))
        self.channels.append(np.full(len(entries), channel))


class MessageIndex:
    """Messages are numbered in the order in which they were written, which is that of their times."""

    def __init__(self, path: Path) -> None:
        """Raises InputError when the file can not be read."""
        self._path = path
        self._chunk_places: list[tuple[int, int]] = []  # where each chunk's content begins, and its length
        self._unpacked: OrderedDict[int, bytes] = OrderedDict()
        self.channels: dict[int, Channel] = {}
        self.schemas: dict[int, Schema] = {}
        gathered = _Gathered()
        try:
            self._stream = path.open("rb")
            self._scan(self._stream, gathered)
        except OSError as error:
            raise InputError(f"{path} can not be read: {error.strerror}") from error
        self.times, self._chunk_of, self._offsets, self.channel_of = _in_order(gathered)

    def close(self) -> None:
        self._stream.close()

    def __len__(self) -> int:
        return len(self.times)

    def until(self, time_ns: int) -> int:
        """How many messages had come by then."""
        return int(np.searchsorted(self.times, time_ns, side="right"))

    def newest(self, count: int) -> list[int]:
        """Of the first `count` messages the last of every channel, in the order in which they came."""
        backwards = self.channel_of[:count][::-1]
        _, first = np.unique(backwards, return_index=True)
        return sorted((count - 1 - first).tolist())

    def data(self, number: int) -> bytes:
        """The message's bytes. Raises InputError where the file is damaged."""
        chunk, offset = int(self._chunk_of[number]), int(self._offsets[number])
        content = self._chunk(chunk)
        _, length, *_ = _MESSAGE_HEAD.unpack_from(content, offset)
        return content[offset + _MESSAGE_HEAD.size : offset + _HEAD.size + length]

    def _scan(self, stream: BufferedReader, gathered: _Gathered) -> None:
        size = self._path.stat().st_size
        stream.seek(MAGIC_BYTES)
        indexed = True
        while len(head := stream.read(_HEAD.size)) == _HEAD.size:
            opcode, length = _HEAD.unpack(head)
            begin = stream.tell()
            if begin + length > size or opcode in (Opcode.DATA_END, Opcode.FOOTER):
                break
            if opcode == Opcode.CHUNK:
                if not indexed:
                    self._look_into(len(self._chunk_places) - 1, gathered)
                self._chunk_places.append((begin, length))
                indexed = False
            elif opcode == Opcode.MESSAGE_INDEX:
                channel, room = _INDEX_HEAD.unpack(stream.read(_INDEX_HEAD.size))
                entries = np.frombuffer(stream.read(room), dtype=_ENTRY)
                chunk = len(self._chunk_places) - 1
                gathered.add(entries, chunk, channel)
                indexed = True
                if channel not in self.channels:
                    self._name_channels(chunk)
            stream.seek(begin + length)
        if not indexed:
            self._look_into(len(self._chunk_places) - 1, gathered)

    def _name_channels(self, chunk: int) -> None:
        for record in breakup_chunk(self._read_chunk(chunk)):
            if isinstance(record, Channel):
                self.channels.setdefault(record.id, record)
            elif isinstance(record, Schema):
                self.schemas.setdefault(record.id, record)

    def _look_into(self, chunk: int, gathered: _Gathered) -> None:
        """A chunk whose index is missing."""
        try:
            self._name_channels(chunk)
            content = self._chunk(chunk)
        except (*DAMAGE, InputError):
            return
        found: dict[int, list[tuple[int, int]]] = {}
        for offset, channel, time_ns in _messages(content):
            found.setdefault(channel, []).append((time_ns, offset))
        for channel, entries in found.items():
            gathered.add(np.array(entries, dtype=_ENTRY), chunk, channel)

    def _chunk(self, chunk: int) -> bytes:
        content = self._unpacked.pop(chunk, None)
        if content is None:
            try:
                stream, length = get_chunk_data_stream(self._read_chunk(chunk))
                content = stream.read(length)
            except (*DAMAGE, zstandard.ZstdError) as error:
                raise InputError(f"{self._path} is damaged: {error}") from error
        self._unpacked[chunk] = content
        while len(self._unpacked) > CHUNKS_KEPT:
            self._unpacked.popitem(last=False)
        return content

    def _read_chunk(self, chunk: int) -> Chunk:
        begin, length = self._chunk_places[chunk]
        self._stream.seek(begin)
        chunk_record: Chunk = Chunk.read(ReadDataStream(BytesIO(self._stream.read(length))))
        return chunk_record


def _in_order(gathered: _Gathered) -> tuple[Ints, Ints, Ints, Ints]:
    if not gathered.times:
        empty = np.zeros(0, dtype=np.int64)
        return empty, empty, empty, empty
    times, chunks = np.concatenate(gathered.times), np.concatenate(gathered.chunks)
    offsets, channels = np.concatenate(gathered.offsets), np.concatenate(gathered.channels)
    order = np.lexsort((offsets, chunks))
    # A clock that was set back within a recording would make "until when" ambiguous: time only ever goes on here.
    return np.maximum.accumulate(times[order]), chunks[order], offsets[order], channels[order]


def _messages(content: bytes) -> Iterator[tuple[int, int, int]]:
    """Offset, channel and log time (ns) of each message in an unpacked chunk."""
    offset = 0
    while offset + _HEAD.size <= len(content):
        opcode, length = _HEAD.unpack_from(content, offset)
        if opcode == Opcode.MESSAGE:
            _, _, channel, _, time_ns, _ = _MESSAGE_HEAD.unpack_from(content, offset)
            yield offset, channel, time_ns
        offset += _HEAD.size + length
