"""Packets of Dynamixel Protocol 2.0: FF FF FD 00, id, length, instruction, parameters, CRC (e-manual, protocol 2)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from robot_agent.hardware.servos.checksum import crc16

HEADER = b"\xff\xff\xfd\x00"
_STUFFED = b"\xff\xff\xfd"
BROADCAST = 0xFE
HIGHEST_ID = 0xFC
ALERT = 0x80
"""Bit of a status packet's error: the servo's register of hardware errors is not 0."""
ENVELOPE = 9
"""Bytes of a packet around its content: header, reserved, id, length (2), CRC (2)."""
STATUS_OVERHEAD = 11
"""Bytes of a status packet beside its parameters."""
LONGEST_CONTENT = 1024 - ENVELOPE
"""What the SDK's buffers hold; a length beyond it is damage."""


class Instruction(IntEnum):
    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    FACTORY_RESET = 0x06
    REBOOT = 0x08
    CLEAR = 0x10
    BACKUP = 0x20
    STATUS = 0x55
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83
    FAST_SYNC_READ = 0x8A
    BULK_READ = 0x92
    BULK_WRITE = 0x93
    FAST_BULK_READ = 0x9A


class Fault(IntEnum):
    """Error number of a status packet, its lower seven bits."""

    NONE = 0
    RESULT_FAIL = 1
    INSTRUCTION = 2
    CRC = 3
    DATA_RANGE = 4
    DATA_LENGTH = 5
    DATA_LIMIT = 6
    ACCESS = 7


@dataclass(frozen=True, slots=True)
class Frame:
    """A packet whose CRC is right; `content` begins with the instruction and is as it was on the wire."""

    id: int
    content: bytes

    @property
    def instruction(self) -> int:
        return self.content[0]

    @property
    def parameters(self) -> bytes:
        """What follows the instruction, freed of stuffing."""
        return unstuffed(self.content)[1:]


@dataclass(frozen=True, slots=True)
class Status:
    """A servo's answer."""

    id: int
    error: int  # error number, and ALERT
    parameters: bytes


def stuffed(content: bytes) -> bytes:
    """With FD after each FF FF FD, so that no header seems to begin inside a packet."""
    return content.replace(_STUFFED, _STUFFED + b"\xfd")


def unstuffed(content: bytes) -> bytes:
    return content.replace(_STUFFED + b"\xfd", _STUFFED)


def encode(servo: int, instruction: int, parameters: bytes = b"") -> bytes:
    """The bytes of an instruction packet."""
    return _enveloped(servo, stuffed(bytes([instruction]) + parameters))


def encode_status(servo: int, error: int, parameters: bytes = b"") -> bytes:
    return encode(servo, Instruction.STATUS, bytes([error]) + parameters)


def encode_fast_status(statuses: list[Status]) -> bytes:
    """The one packet in which several servos answer a fast read, each with its own CRC over all so far, unstuffed."""
    length = 1 + sum(len(status.parameters) + 4 for status in statuses)
    message = HEADER + bytes([BROADCAST]) + length.to_bytes(2, "little") + bytes([Instruction.STATUS])
    for status in statuses:
        message += bytes([status.error, status.id]) + status.parameters
        message += crc16(message).to_bytes(2, "little")
    return message


def status_of(frame: Frame) -> Status | None:
    """The answer of one servo, or None where the frame is something else."""
    if frame.instruction != Instruction.STATUS or frame.id > HIGHEST_ID or len(frame.content) < 2:
        return None
    parameters = frame.parameters
    return Status(frame.id, parameters[0], parameters[1:])


def fast_statuses_of(frame: Frame, expected: list[tuple[int, int]]) -> list[Status]:
    """Answers of the servos `expected` (id, length of data) to a fast read; empty if it is no such answer."""
    # The last servo's CRC is the frame's own, which the reader has taken off.
    length = 1 + sum(size + 4 for _, size in expected) - 2
    if frame.instruction != Instruction.STATUS or frame.id != BROADCAST or len(frame.content) != length:
        return []
    statuses, start = [], 1
    for servo, size in expected:
        if frame.content[start + 1] != servo:
            return []
        statuses.append(Status(servo, frame.content[start], frame.content[start + 2 : start + 2 + size]))
        start += size + 4
    return statuses


def _enveloped(servo: int, content: bytes) -> bytes:
    message = HEADER + bytes([servo]) + (len(content) + 2).to_bytes(2, "little") + content
    return message + crc16(message).to_bytes(2, "little")
