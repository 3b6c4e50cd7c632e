"""Of many servos asked at once, each sound answer counts and no other."""

from __future__ import annotations

import numpy as np
import pytest

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


@pytest.mark.parametrize("line", FUZZES)
def test_no_damaged_record_is_believed(line: str) -> None:
    count = FUZZES[line](4000, 1)
    assert count.damaged >= 4000
    assert count.wrong == 0
    # The IMUs' parsers want a second record before they believe the first, and the last may still be coming.
    # A servo's answer beside which bytes are missing or too many is given up: once in 65 536 its CRC fits by chance.
    assert count.sound_lost <= (0.025 * count.sound if line == "servo" else 2)
