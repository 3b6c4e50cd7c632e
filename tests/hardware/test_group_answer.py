"""Of many servos asked at once, each sound answer counts and no other."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from robot_agent.hardware.servos.checksum import crc16_of_rows
from robot_agent.hardware.servos.frame_reader import FrameReader
from robot_agent.hardware.servos.group_answer import GroupAnswer
from robot_agent.hardware.servos.health_block import (
    READ,
    READ_TYPE,
    WRITTEN,
    WRITTEN_TYPE,
    indirect_addresses,
    plausible,
)
from robot_agent.hardware.servos.packet import ALERT, encode_status
from sim_agent.wire_fuzz import FUZZES
from sim_agent.wire_noise import damaged

IDS = [3, 1, 2]


def answers(*, without: tuple[int, ...] = (), data: bytes = bytes(range(10))) -> list[bytes]:
    return [encode_status(servo, 0, data) for servo in IDS if servo not in without]


def gathered(*parts: bytes) -> GroupAnswer:
    group = GroupAnswer(IDS, 10)
    group.begin()
    for part in parts:
        group.feed(part)
    group.finish()
    return group


def test_everybody_who_answers_counts() -> None:
    group = gathered(*answers())
    assert group.complete
    assert group.valid.all()
    assert (group.data == np.arange(10)).all()


def test_a_silent_servo_is_the_only_one_missing() -> None:
    group = gathered(*answers(without=(1,)))
    assert not group.complete
    assert list(group.valid) == [True, False, True]


def test_stuffed_answers_are_read_as_they_were_sent() -> None:
    current, velocity = (-1).to_bytes(2, "little", signed=True), (-3).to_bytes(4, "little", signed=True)
    data = current + velocity + bytes(4)
    assert b"\xff\xff\xfd" in data
    group = gathered(*answers(data=data))
    assert group.valid.all()
    assert group.data[1].tobytes() == data


def test_the_alert_bit_is_kept() -> None:
    first, second, third = answers()
    group = gathered(first, encode_status(1, ALERT, bytes(10)), third)
    assert list(group.error) == [0, ALERT, 0]
    assert group.valid.all()
    assert len(second) == len(first)


def test_answers_out_of_order_find_their_servo() -> None:
    parts = [encode_status(servo, 0, bytes([servo] * 10)) for servo in (1, 2, 3)]
    assert list(gathered(*parts).data[:, 0]) == IDS


def test_two_servos_with_the_same_id_are_not_believed() -> None:
    assert list(gathered(*answers(), encode_status(2, 0, bytes(10))).valid) == [True, True, False]


def test_last_cycles_answers_do_not_count_again() -> None:
    group = gathered(*answers())
    group.begin()
    assert not group.finish().any()


def test_blocks_are_as_long_as_the_registers_they_gather() -> None:
    assert READ_TYPE.itemsize == sum(register.size for register in READ) == 17
    assert WRITTEN_TYPE.itemsize == sum(register.size for register in WRITTEN)
    assert len(indirect_addresses()) == 2 * (READ_TYPE.itemsize + WRITTEN_TYPE.itemsize)


def test_a_servo_that_lost_its_indirect_addresses_is_not_believed() -> None:
    zeros = np.zeros(1, dtype=READ_TYPE)
    assert not plausible(zeros, np.array([7], dtype=np.uint8))[0]


def slipped(count: int) -> bytes:
    """Answers of which the first has lost (`count` < 0) or gained bytes so that a CRC fits by chance all the same."""
    values = np.random.default_rng(3)
    data = values.integers(0, 256, size=(400_000, 10), dtype=np.uint8)
    empty, following, last = answers(data=bytes(10))
    rows = np.tile(np.frombuffer(empty, dtype=np.uint8), (len(data), 1))
    rows[:, 9:-2] = data
    printed = crc16_of_rows(rows[:, :-2])
    rows[:, -2], rows[:, -1] = printed & 0xFF, printed >> 8
    if count < 0:
        rows = np.delete(rows, range(12, 12 - count), axis=1)
    else:
        rows = np.insert(rows, [12] * count, values.integers(0, 256, size=(len(data), count), dtype=np.uint8), axis=1)
    ahead = np.tile(np.frombuffer(following, dtype=np.uint8), (len(data), 1))
    seen = np.hstack([rows, ahead])[:, : len(empty)]
    fits = np.flatnonzero(crc16_of_rows(seen[:, :-2]) == seen[:, -2] | seen[:, -1].astype(np.uint16) << 8)
    return rows[fits[0]].tobytes() + following + last


@pytest.mark.parametrize("count", [-3, -2, -1, 1, 2, 3])
def test_an_answer_that_slipped_is_not_believed_though_its_crc_fits(count: int) -> None:
    wire = slipped(count)
    frames = FrameReader().feed(wire)
    assert frames[0].id == IDS[0]  # by its CRC alone it would be
    group = gathered(wire)
    assert not group.valid[0]
    assert group.valid[2]


def test_an_answer_cut_short_is_not_believed_with_the_next_ones_bytes() -> None:
    first, second, third = answers()
    length = len(first) - 9
    for cut in range(4, 10):
        values = np.random.default_rng(cut)
        data = values.integers(0, 256, size=(400_000, 10 - cut + 2), dtype=np.uint8)
        beginning = np.tile(np.frombuffer(first[:9], dtype=np.uint8), (len(data), 1))
        ahead = np.tile(np.frombuffer(second, dtype=np.uint8), (len(data), 1))
        seen = np.hstack([beginning, data, ahead])[:, : len(first)]
        fits = np.flatnonzero(crc16_of_rows(seen[:, :-2]) == seen[:, -2] | seen[:, -1].astype(np.uint16) << 8)
        wire = first[:9] + data[fits[0]].tobytes() + second + third
        assert len(FrameReader().feed(wire)[0].content) == length, cut
        assert not gathered(wire).valid[0], cut


@pytest.mark.parametrize("kind", ["lost", "inserted", "bits", "burst", "byte", "cut"])
def test_a_damaged_header_does_not_cost_the_answer_before_it(kind: str) -> None:
    first, second, third = answers()
    generator = Random(4)
    for _ in range(300):
        header = damaged(second[:6], kind, generator)
        assert gathered(first, header + second[6:], third).valid[0], header


@pytest.mark.parametrize("line", FUZZES)
def test_no_damaged_record_is_believed(line: str) -> None:
    count = FUZZES[line](4000, 1)
    assert count.damaged >= 4000
    assert count.wrong == 0
    # The IMUs' parsers want a second record before they believe the first, and the last may still be coming.
    assert count.sound_lost <= 2
