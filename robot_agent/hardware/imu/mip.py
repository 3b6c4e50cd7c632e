"""MIP, the packet protocol of 3DM-GX4 and GX5: 75 65, descriptor set, length, fields, two sums (Fletcher).

Everything is big-endian. Descriptors as in the vendor's mip_sdk.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

from robot_agent.hardware.imu.continuity import Continuity
from robot_agent.hardware.imu.record import STANDARD_GRAVITY, InertialRecord, possible

SYNC = b"\x75\x65"
BASE, THREE_DM, SENSOR = 0x01, 0x0C, 0x80
ACCELERATION, ANGULAR_RATE, GPS_TIME, REFERENCE_TIME = 0x04, 0x05, 0x12, 0xD5
REPLY = 0xF1
_VECTOR = struct.Struct(">3f")
_GPS_TIME = struct.Struct(">dHH")
SECONDS_PER_WEEK = 604_800
LENGTH = 48
"""Bytes of a record: two vectors and a time."""
BASE_RATE = 1000  # Hz of the GX5's inertial data; a message comes every so many of them


def fletcher(data: bytes) -> bytes:
    first = second = 0
    for byte in data:
        first = (first + byte) & 0xFF
        second = (second + first) & 0xFF
    return bytes([first, second])


def packet(descriptor_set: int, *fields: tuple[int, bytes]) -> bytes:
    """A packet of fields (descriptor, data)."""
    payload = b"".join(bytes([len(data) + 2, descriptor]) + data for descriptor, data in fields)
    message = SYNC + bytes([descriptor_set, len(payload)]) + payload
    return message + fletcher(message)


def ping() -> bytes:
    return packet(BASE, (0x01, b""))


def idle() -> bytes:
    return packet(BASE, (0x02, b""))


def message_format(rate: int) -> bytes:
    """Acceleration, angular rate and the device's time, `rate` Hz, which must divide 1000."""
    decimation = BASE_RATE // rate
    wanted = b"".join(struct.pack(">BH", what, decimation) for what in (ACCELERATION, ANGULAR_RATE, GPS_TIME))
    return packet(THREE_DM, (0x08, b"\x01\x03" + wanted))


def start_streaming() -> bytes:
    return packet(THREE_DM, (0x11, b"\x01\x01\x01"))


class MipParser:
    """Turns the device's bytes into records; replies and damage between them are passed over."""

    def __init__(self) -> None:
        self._buffer = b""
        self._continuity = Continuity()

    @property
    def jumps(self) -> int:
        return self._continuity.jumps

    def feed(self, data: bytes) -> list[InertialRecord]:
        buffer, at, records = self._buffer + data, 0, []
        while (at := buffer.find(SYNC, at)) >= 0 and len(buffer) - at >= 6:
            end = at + 6 + buffer[at + 3]
            if end > len(buffer):
                # Perhaps a damaged length: the packets behind it stay in the buffer until it is there and found wrong.
                break
            if fletcher(buffer[at : end - 2]) != buffer[end - 2 : end]:
                at += 1
                continue
            if (record := _record(buffer[at:end])) is not None:
                records += self._continuity.accept(record)
            at = end
        self._buffer = buffer[at:] if at >= 0 else buffer[-1:]
        return records


def fields(raw: bytes) -> Iterator[tuple[int, bytes]]:
    """Descriptor and data of each field of a whole packet; ends where a length can not be."""
    at = 4
    while at + 2 <= len(raw) - 2 and 2 <= raw[at] <= len(raw) - 2 - at:
        yield raw[at + 1], raw[at + 2 : at + raw[at]]
        at += raw[at]


def _record(raw: bytes) -> InertialRecord | None:
    if raw[2] != SENSOR:
        return None
    found = dict(fields(raw))
    stamp_ns = _device_ns(found)
    force, rate = found.get(ACCELERATION, b""), found.get(ANGULAR_RATE, b"")
    if stamp_ns is None or len(force) != _VECTOR.size or len(rate) != _VECTOR.size:
        return None
    x, y, z = (value * STANDARD_GRAVITY for value in _VECTOR.unpack(force))
    turning = _VECTOR.unpack(rate)
    if not possible((x, y, z), turning):
        return None
    return InertialRecord(stamp_ns, (x, y, z), turning)


def _device_ns(found: dict[int, bytes]) -> int | None:
    """The device's time: nanoseconds of newer devices, or week and time of week, which also run without GPS."""
    if len(found.get(REFERENCE_TIME, b"")) == 8:
        return int.from_bytes(found[REFERENCE_TIME], "big")
    if len(found.get(GPS_TIME, b"")) != _GPS_TIME.size:
        return None
    seconds, week, _ = _GPS_TIME.unpack(found[GPS_TIME])
    if not 0.0 <= seconds < SECONDS_PER_WEEK:
        return None
    return round(float(seconds) * 1e9) + int(week) * SECONDS_PER_WEEK * 1_000_000_000
