"""Packets of Dynamixel Protocol 2.0 are the manual's, survive any content and any cutting up of the stream."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.hardware.servos.checksum import crc16, crc16_of_rows
from robot_agent.hardware.servos.frame_reader import FrameReader
from robot_agent.hardware.servos.packet import (
    Status,
    encode,
    encode_fast_status,
    encode_status,
    fast_statuses_of,
    status_of,
    stuffed,
    unstuffed,
)

# Every instruction packet printed in the e-manual (docs/en/dxl/protocol2): id, instruction, parameters, bytes.
INSTRUCTIONS = {
    "ping": (1, 0x01, "", "FFFFFD00 01 0300 01 194E"),
    "ping all": (0xFE, 0x01, "", "FFFFFD00 FE 0300 01 3142"),
    "read": (1, 0x02, "84000400", "FFFFFD00 01 0700 02 84000400 1D15"),
    "write": (1, 0x03, "740000020000", "FFFFFD00 01 0900 03 740000020000 CA89"),
    "register write": (1, 0x04, "6800C8000000", "FFFFFD00 01 0900 04 6800C8000000 AE8E"),
    "action": (1, 0x05, "", "FFFFFD00 01 0300 05 02CE"),
    "factory reset": (1, 0x06, "01", "FFFFFD00 01 0400 06 01 A1E6"),
    "reboot": (1, 0x08, "", "FFFFFD00 01 0300 08 2F4E"),
    "clear": (1, 0x10, "0144584C22", "FFFFFD00 01 0800 10 0144584C22 B1DC"),
    "backup": (1, 0x20, "014354524C", "FFFFFD00 01 0800 20 014354524C 16F5"),
    "sync read": (0xFE, 0x82, "840004000102", "FFFFFD00 FE 0900 82 840004000102 CEFA"),
    "sync write": (
        0xFE,
        0x83,
        "74000400 0196000000 02AA000000",
        "FFFFFD00 FE 1100 83 74000400 0196000000 02AA000000 8287",
    ),
    "fast sync read": (0xFE, 0x8A, "84000400030704", "FFFFFD00 FE 0A00 8A 84000400030704 20F2"),
    "bulk read": (0xFE, 0x92, "0190000200 0292000100", "FFFFFD00 FE 0D00 92 0190000200 0292000100 1A05"),
    "bulk write": (
        0xFE,
        0x93,
        "0120000200A000 021F00010050",
        "FFFFFD00 FE 1000 93 0120000200A000 021F00010050 B768",
    ),
}
# Every status packet printed there: id, error, parameters, bytes.
STATUSES = {
    "ping": (1, "060426", "FFFFFD00 01 0700 55 00 060426 655D"),
    "ping of the second": (2, "060426", "FFFFFD00 02 0700 55 00 060426 6F6D"),
    "read": (1, "A6000000", "FFFFFD00 01 0800 55 00 A6000000 8CC0"),
    "sync read of the second": (2, "1F080000", "FFFFFD00 02 0800 55 00 1F080000 BABE"),
    "write": (1, "", "FFFFFD00 01 0400 55 00 A10C"),
    "bulk read": (1, "7700", "FFFFFD00 01 0600 55 00 7700 C369"),
    "bulk read of the second": (2, "24", "FFFFFD00 02 0500 55 00 24 8BA9"),
}
# The two answers to fast reads printed there, in parts as three servos send them.
FAST_STATUSES = {
    "sync": (
        [(3, "A6000000"), (7, "1F080000"), (4, "FF030000")],
        "FFFFFD00 FE 1900 55 00 03 A6000000 8408 00 07 1F080000 16CA 00 04 FF030000 D19E",
    ),
    "bulk": (
        [(3, "A6000000"), (7, "A501"), (4, "1F")],
        "FFFFFD00 FE 1400 55 00 03 A6000000 67A4 00 07 A501 2474 00 04 1F D9C1",
    ),
}

# "fast bulk read" carries the CRC printed for "fast sync read"; one digit of the CRC of "restore" is wrong.
MISPRINTS = {
    "fast bulk read": (0x9A, "FFFFFD00 FE 1200 9A 0384000400 077C000200 0492000100 20F2"),
    "restore": (0x20, "FFFFFD00 01 0800 20 024354524C 92F5"),
}

NEAR_HEADERS = st.lists(st.sampled_from([b"\xff", b"\xfd", b"\xff\xff\xfd", b"\x00", b"\x55", b"\x01"])).map(b"".join)


@pytest.mark.parametrize("name", INSTRUCTIONS)
def test_instruction_packets_are_the_manuals(name: str) -> None:
    servo, instruction, parameters, wire = INSTRUCTIONS[name]
    assert encode(servo, instruction, bytes.fromhex(parameters)) == bytes.fromhex(wire)
    (frame,) = FrameReader().feed(bytes.fromhex(wire))
    assert (frame.id, frame.instruction, frame.parameters) == (servo, instruction, bytes.fromhex(parameters))


@pytest.mark.parametrize("name", STATUSES)
def test_status_packets_are_the_manuals(name: str) -> None:
    servo, parameters, wire = STATUSES[name]
    assert encode_status(servo, 0, bytes.fromhex(parameters)) == bytes.fromhex(wire)
    (frame,) = FrameReader().feed(bytes.fromhex(wire))
    assert status_of(frame) == Status(servo, 0, bytes.fromhex(parameters))


@pytest.mark.parametrize("name", FAST_STATUSES)
def test_answers_to_fast_reads_are_the_manuals(name: str) -> None:
    parts, wire = FAST_STATUSES[name]
    statuses = [Status(servo, 0, bytes.fromhex(data)) for servo, data in parts]
    assert encode_fast_status(statuses) == bytes.fromhex(wire)
    (frame,) = FrameReader().feed(bytes.fromhex(wire))
    assert fast_statuses_of(frame, [(status.id, len(status.parameters)) for status in statuses]) == statuses


@pytest.mark.parametrize(("instruction", "wire"), MISPRINTS.values(), ids=MISPRINTS)
def test_two_packets_of_the_manual_are_misprinted(instruction: int, wire: str) -> None:
    """By the manual's own rules nobody could receive them; all but their CRCs are as we send them."""
    printed = bytes.fromhex(wire)
    assert FrameReader().feed(printed) == []
    assert encode(printed[4], instruction, printed[8:-2])[:-2] == printed[:-2]


@given(content=st.one_of(st.binary(max_size=60), NEAR_HEADERS))
def test_stuffing_leaves_no_header_and_is_undone(content: bytes) -> None:
    assert b"\xff\xff\xfd\x00" not in stuffed(content)
    assert unstuffed(stuffed(content)) == content


@given(
    servo=st.integers(0, 0xFC),
    error=st.integers(0, 0xFE),
    parameters=st.one_of(st.binary(max_size=40), NEAR_HEADERS),
    cuts=st.lists(st.integers(1, 20), max_size=8),
)
def test_status_packets_come_back_however_the_stream_is_cut(
    servo: int, error: int, parameters: bytes, cuts: list[int]
) -> None:
    wire = b"\x00\xff\xff" + encode_status(servo, error, parameters) * 2
    reader = FrameReader()
    frames = []
    for cut in [*cuts, len(wire)]:
        frames += reader.feed(wire[:cut])
        wire = wire[cut:]
    assert [status_of(frame) for frame in frames] == [Status(servo, error, parameters)] * 2


@given(lost=st.integers(0, 17))
def test_a_frame_cut_short_does_not_swallow_the_next(lost: int) -> None:
    first, second = encode_status(1, 0, bytes(10)), encode_status(2, 0, bytes(10))
    reader = FrameReader()
    frames = reader.feed(first[: len(first) - 1 - lost] + second) + reader.finish()
    assert [frame.id for frame in frames] == [2]


@given(rows=st.integers(1, 8), length=st.integers(1, 40), seed=st.integers(0, 1000))
def test_crc_of_many_is_the_crc_of_each(rows: int, length: int, seed: int) -> None:
    messages = np.random.default_rng(seed).integers(0, 256, (rows, length), dtype=np.uint8)
    assert list(crc16_of_rows(messages)) == [crc16(message.tobytes()) for message in messages]


@given(parameters=st.binary(min_size=4, max_size=30), flips=st.sets(st.integers(0, 119), min_size=1, max_size=3))
def test_one_to_three_flipped_bits_are_always_found(parameters: bytes, flips: set[int]) -> None:
    wire = bytearray(encode_status(9, 0, parameters))
    for bit in flips:
        wire[bit // 8] ^= 1 << bit % 8
    reader = FrameReader()
    assert reader.feed(bytes(wire)) + reader.finish() == []
