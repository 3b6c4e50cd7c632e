"""GVCP, the control protocol of GigE Vision: questions and answers of registers, one UDP packet each, big-endian."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum

PORT = 3956
_QUESTION = 0x42
_ANSWER_WANTED = 0x01
_HEADER = struct.Struct(">BBHHH")
_ANSWER = struct.Struct(">HHHH")
_RESEND = struct.Struct(">HHII")


class Command(IntEnum):
    DISCOVER = 0x0002
    RESEND = 0x0040
    READ_REGISTERS = 0x0080
    WRITE_REGISTERS = 0x0082
    READ_MEMORY = 0x0084
    WRITE_MEMORY = 0x0086


class Status(IntEnum):
    SUCCESS = 0x0000
    NOT_IMPLEMENTED = 0x8001
    INVALID_PARAMETER = 0x8002
    INVALID_ADDRESS = 0x8003
    ACCESS_DENIED = 0x8006


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    command: int
    number: int  # comes back with the answer
    payload: bytes
    answer_wanted: bool

    def words(self) -> tuple[int, ...]:
        """The payload as numbers of 32 bits."""
        return struct.unpack(f">{len(self.payload) // 4}I", self.payload[: len(self.payload) // 4 * 4])


@dataclass(frozen=True, slots=True, kw_only=True)
class Resend:
    """Packets `first` to `last` of a frame that did not arrive."""

    frame: int
    first: int
    last: int


def question(data: bytes) -> Question | None:
    """What a packet asks, or None where it is something else."""
    if len(data) < _HEADER.size:
        return None
    kind, flags, command, length, number = _HEADER.unpack_from(data)
    payload = data[_HEADER.size :]
    if kind != _QUESTION or len(payload) < length:
        return None
    return Question(
        command=command, number=number, payload=payload[:length], answer_wanted=bool(flags & _ANSWER_WANTED)
    )


def answer(asked: Question, payload: bytes = b"", status: Status = Status.SUCCESS) -> bytes:
    return _ANSWER.pack(status, asked.command + 1, len(payload), asked.number) + payload


def resend(asked: Question) -> Resend:
    _, frame, first, last = _RESEND.unpack_from(asked.payload)
    return Resend(frame=frame, first=first & 0xFFFFFF, last=last & 0xFFFFFF)
