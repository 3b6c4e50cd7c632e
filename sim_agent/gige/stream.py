"""GVSP, the pictures of GigE Vision: a leader, the payload in pieces and a trailer, each a UDP packet, big-endian."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from sim_agent.gige.features import MONO8

OVERHEAD = 20 + 8 + 8
"""Bytes of IP, UDP and GVSP in what a packet's size counts."""
LAST_FRAME = 65_535
_IMAGE, _WITH_CHUNKS = 0x0001, 0x4000
_LEADER, _TRAILER, _PAYLOAD = 1, 2, 3
_HEADER = struct.Struct(">HHI")
_IMAGE_LEADER = struct.Struct(">HHQIIIIIHH")
_IMAGE_TRAILER = struct.Struct(">HHI")
_CHUNK = struct.Struct(">II")


@dataclass(frozen=True, slots=True, kw_only=True)
class Chunk:
    """A figure that comes with a picture."""

    id: int
    data: bytes


def packets(
    frame: int, stamp_ns: int, pixels: bytes, size: tuple[int, int], packet_size: int, chunks: list[Chunk]
) -> list[bytes]:
    """All packets of a picture of `size` (width, height); `chunks` follow its pixels, none: no chunk mode."""
    kind = _IMAGE | (_WITH_CHUNKS if chunks else 0)
    payload = pixels
    if chunks:
        payload += _CHUNK.pack(0, len(pixels)) + b"".join(
            one.data + _CHUNK.pack(one.id, len(one.data)) for one in chunks
        )
    piece = packet_size - OVERHEAD
    contents = [(_LEADER, _IMAGE_LEADER.pack(0, kind, stamp_ns, MONO8, *size, 0, 0, 0, 0))]
    contents += [(_PAYLOAD, payload[at : at + piece]) for at in range(0, len(payload), piece)]
    contents.append((_TRAILER, _IMAGE_TRAILER.pack(0, kind, size[1])))
    return [_HEADER.pack(0, frame, what << 24 | number) + content for number, (what, content) in enumerate(contents)]


def payload_size(pixels: int, chunks: list[Chunk]) -> int:
    return pixels + (_CHUNK.size + sum(len(one.data) + _CHUNK.size for one in chunks) if chunks else 0)
