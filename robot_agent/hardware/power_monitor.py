"""The battery's monitor: an Arduino that sends a line of fixed length 90 times a second (firmware/power_monitor).

$PWR,<sequence>,<ms>,<mV>,<mA>,<mWh>,<flags>*<CRC>: decimals with leading zeros, so that a lost or added character is
found by the length, and a CRC-16 (polynomial 0x1021, beginning with 0) over all between $ and *. Energy is summed up
by the monitor, so that lost lines lose none of it.
"""

from __future__ import annotations

import re
from binascii import crc_hqx
from dataclasses import dataclass

from robot_agent.hardware.imu.clock_map import ClockMap
from robot_agent.hardware.serial_line import ByteLine
from robot_agent.hardware.sources import PowerReading

BAUD = 115_200
RATE = 90.0  # lines a second
_LINE = re.compile(
    rb"\$(PWR,(\d{5}),(\d{10}),(\d{5}),([+-]\d{6}),([+-]\d{8}),([0-9A-F]{2}))\*([0-9A-F]{4})\r\n", re.ASCII
)
LINE_LENGTH = 55
SEQUENCES = 1 << 16
MILLISECONDS = 1 << 32
J_PER_MWH = 3.6
RELAY_CLOSED, SENSOR_MISSING = 0x01, 0x02
"""Bits of the flags."""
HEARTBEAT = b"HB\n"
"""Where the monitor guards the motors' relay, half a second without it opens the relay."""
HEARTBEAT_NS = 100_000_000
OPEN_RELAY, CLOSE_RELAY = b"RELAY 0\n", b"RELAY 1\n"


@dataclass(frozen=True, slots=True)
class PowerRecord:
    sequence: int
    device_ms: int
    millivolts: int
    milliamperes: int
    milliwatt_hours: int
    flags: int


def encode(record: PowerRecord) -> bytes:
    """The line that the monitor sends."""
    body = (
        f"PWR,{record.sequence % SEQUENCES:05d},{record.device_ms % MILLISECONDS:010d},{record.millivolts:05d},"
        f"{record.milliamperes:+07d},{record.milliwatt_hours:+09d},{record.flags:02X}"
    ).encode()
    return b"$" + body + b"*%04X\r\n" % crc_hqx(body, 0)


class PowerParser:
    """Turns the monitor's bytes into records; counts lines that were lost between them."""

    def __init__(self) -> None:
        self._buffer = b""
        self._sequence: int | None = None
        self.lost = 0

    def feed(self, data: bytes) -> list[PowerRecord]:
        self._buffer += data
        records = []
        end = 0
        for match in _LINE.finditer(self._buffer):
            end = match.end()
            body, *_, flags, printed = match.groups()
            if crc_hqx(body, 0) == int(printed, 16):
                sequence, device_ms, volts, amperes, energy = (int(text) for text in match.groups()[1:6])
                records.append(PowerRecord(sequence, device_ms, volts, amperes, energy, int(flags, 16)))
                self._count(sequence)
        # What is left may be the beginning of a line.
        self._buffer = self._buffer[end:][-LINE_LENGTH:]
        return records

    def _count(self, sequence: int) -> None:
        if self._sequence is not None:
            self.lost += (sequence - self._sequence - 1) % SEQUENCES
        self._sequence = sequence


class PowerMonitor:
    """A `robot_agent.hardware.sources.PowerSource`."""

    def __init__(self, line: ByteLine) -> None:
        self._line = line
        self._parser = PowerParser()
        self._clock = ClockMap()
        self._beat_ns = 0
        self.relay_closed: bool | None = None
        """As the monitor last said."""
        self._last_ms = 0
        self._laps = 0

    @property
    def lost(self) -> int:
        """Lines that were sent and not understood, as far as their numbers tell."""
        return self._parser.lost

    def take(self, now_ns: int) -> PowerReading | None:
        if now_ns >= self._beat_ns:
            self._beat_ns = now_ns + HEARTBEAT_NS
            self._line.send(HEARTBEAT)
        newest = None
        for record in self._parser.feed(self._line.receive(now_ns)):
            device_ns = self._unwrapped_ms(record.device_ms) * 1_000_000
            self._clock.observe(device_ns, now_ns)
            self.relay_closed = bool(record.flags & RELAY_CLOSED)
            if not record.flags & SENSOR_MISSING:
                newest = PowerReading(
                    stamp_ns=self._clock.at(device_ns),
                    voltage=record.millivolts * 1e-3,
                    current=record.milliamperes * 1e-3,
                    energy=record.milliwatt_hours * J_PER_MWH,
                )
        return newest

    def switch_relay(self, *, closed: bool) -> None:
        """The motors' supply; whatever holds the robot up goes with it."""
        self._line.send(CLOSE_RELAY if closed else OPEN_RELAY)

    def close(self) -> None:
        self._line.close()

    def _unwrapped_ms(self, device_ms: int) -> int:
        if self._last_ms - device_ms > MILLISECONDS // 2:
            self._laps += 1
        self._last_ms = device_ms
        return self._laps * MILLISECONDS + device_ms
