"""The memory of an emulated camera: the standard's registers, the features', and the file that describes these."""

from __future__ import annotations

import ipaddress
import struct

from sim_agent.gige.features import FEATURES, LINES, Feature, description

PRIVILEGE, HEARTBEAT_TIMEOUT = 0x0A00, 0x0938
STREAM_PORT, PACKET_SIZE, STREAM_ADDRESS = 0x0D00, 0x0D04, 0x0D18
FIRE_TEST = 1 << 31
BOOTSTRAP_LENGTH = 0xF8
"""Bytes that a camera tells of itself when it is looked for."""
_FILE_AT = 0x10000
_RESEND_AND_WRITE_MEMORY = 0b110
_TICKS_PER_SECOND = 1_000_000_000


class Registers:
    """Read and written by address; features also by name."""

    def __init__(self, address: str, serial: str, size: tuple[int, int]) -> None:
        file = description()
        self._bytes = bytearray(_FILE_AT + len(file))
        self._bytes[_FILE_AT:] = file
        for place, number in (
            (0x0000, 0x0001_0002),  # version 1.2
            (0x0004, 0x8000_0001),  # big-endian, UTF-8
            (0x000C, 0x0200_0000 | int(ipaddress.IPv4Address(address)) & 0xFFFFFF),
            (0x0014, 0x0000_0001),
            (0x0024, int(ipaddress.IPv4Address(address))),
            (0x0034, 0xFF00_0000),
            (0x0600, 1),
            (0x0904, 1),
            (0x0934, _RESEND_AND_WRITE_MEMORY),
            (HEARTBEAT_TIMEOUT, 3000),
            (0x0940, _TICKS_PER_SECOND),
            (PACKET_SIZE, 8228),
        ):
            self.set_word(place, number)
        for place, text in (
            (0x0048, "Weaver"),
            (0x0068, "Rendered"),
            (0x0088, "1"),
            (0x00D8, serial),
            (0x0200, f"Local:camera.xml;{_FILE_AT:x};{len(file):x}"),
        ):
            self._bytes[place : place + len(text)] = text.encode()
        for feature in FEATURES.values():
            for line in LINES if feature.per_line else [""]:
                self.set_value(feature.name, feature.default, line)
        self.set_value("Width", size[0])
        self.set_value("Height", size[1])

    def read(self, address: int, length: int) -> bytes | None:
        """None where there is no memory."""
        return bytes(self._bytes[address : address + length]) if address + length <= len(self._bytes) else None

    def write(self, address: int, data: bytes) -> bool:
        """False where there is no memory to write."""
        if address + len(data) > _FILE_AT:
            return False
        self._bytes[address : address + len(data)] = data
        return True

    def word(self, address: int) -> int:
        return int.from_bytes(self._bytes[address : address + 4], "big")

    def set_word(self, address: int, value: int) -> None:
        self._bytes[address : address + 4] = (value & 0xFFFF_FFFF).to_bytes(4, "big")

    def value(self, name: str, line: str = "") -> float:
        feature = FEATURES[name]
        raw = self._bytes[_place(feature, line) :][:4]
        return float(struct.unpack(">f" if feature.kind == "Float" else ">I", raw)[0])

    def set_value(self, name: str, value: float, line: str = "") -> None:
        feature, place = FEATURES[name], _place(FEATURES[name], line)
        raw = struct.pack(">f", value) if feature.kind == "Float" else struct.pack(">I", int(value))
        self._bytes[place : place + 4] = raw

    def chosen(self, name: str, line: str = "") -> str:
        """The name of an enumeration's value; empty where it has none."""
        value = self.value(name, line)
        return next((entry for entry, number in FEATURES[name].entries.items() if number == value), "")


def _place(feature: Feature, line: str) -> int:
    return feature.address + (4 * LINES[line] if feature.per_line and line else 0)
