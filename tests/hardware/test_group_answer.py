"""Of many servos asked at once, each sound answer counts and no other."""

from __future__ import annotations

from itertools import pairwise
from random import Random

import numpy as np
import pytest

from robot_agent.hardware.servos.checksum import crc16
from robot_agent.hardware.servos.group_answer import GroupAnswer
from robot_agent.hardware.servos.health_block import (
    READ,
    READ_TYPE,
    WRITTEN,
    WRITTEN_TYPE,
    indirect_addresses,
    plausible,
)
from robot_agent.hardware.servos.packet import ALERT, HEADER, STATUS_OVERHEAD, Fault, encode_status
from robot_agent.hardware.servos.registers import RAM_BEGINS, WATCHDOG_TRIPPED
from sim_agent.wire_fuzz import FUZZES, answers_in_motion
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


def test_a_servo_that_found_a_fault_in_the_question_sends_no_values() -> None:
    first, _, third = answers()
    assert list(gathered(first, encode_status(1, Fault.ACCESS, bytes(10)), third).valid) == [True, False, True]


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


def test_blocks_show_ram_alone() -> None:
    assert min(register.address for register in READ + WRITTEN) >= RAM_BEGINS


def test_a_servo_that_lost_its_indirect_addresses_is_not_believed() -> None:
    assert not plausible(np.zeros(1, dtype=READ_TYPE))[0]


def blocks(count: int) -> np.ndarray:
    """Blocks of READ_TYPE, of which one in four is of a servo whose watchdog tripped."""
    result = answers_in_motion(count, np.random.default_rng(5))
    result["watchdog"][::4] = WATCHDOG_TRIPPED
    return result


def believed(packet: bytes) -> bool:
    group = GroupAnswer(IDS[:1], READ_TYPE.itemsize)
    group.begin()
    group.feed(packet)
    return bool((group.finish() & plausible(group.data.view(READ_TYPE)[:, 0]))[0])


def missed_bursts(length: int) -> list[bytes]:
    """All damages up to 16 bits in a row that the CRC of a packet of so many bytes can not tell."""
    checked = length - 2
    places = [(1 << bit).to_bytes(length, "little") for bit in range(8 * length)]
    remainders = [crc16(place[:checked]) ^ int.from_bytes(place[checked:], "little") for place in places]
    missed = []
    for start in range(len(places)):
        left = np.array(remainders[start : start + 1])
        for remainder in remainders[start + 1 : start + 16]:
            left = np.concatenate([left, left ^ remainder])
        missed += [((2 * int(rest) + 1) << start).to_bytes(length, "little") for rest in np.flatnonzero(left == 0)]
    return missed


def test_every_burst_that_the_crc_can_not_tell_is_told_by_the_values() -> None:
    sent = [encode_status(IDS[0], 0, block.tobytes()) for block in blocks(40)]
    length = STATUS_OVERHEAD + READ_TYPE.itemsize
    sent = [wire for wire in sent if len(wire) == length]  # stuffing puts another byte behind its burst
    bursts = missed_bursts(length)
    assert len(bursts) > 100
    assert all(believed(wire) for wire in sent)
    for burst in bursts:
        for wire in sent:
            assert not believed(bytes(a ^ b for a, b in zip(wire, burst, strict=True))), burst.hex()


@pytest.mark.parametrize("count", [-3, -2, -1, 1, 2, 3])
def test_values_of_an_answer_that_slipped_are_refused_whatever_its_crc(count: int) -> None:
    values = np.random.default_rng(6)
    size, refused = READ_TYPE.itemsize, 0
    for block in blocks(400):
        line = block.tobytes() + values.bytes(2) + HEADER
        for place in range(size):
            begun = line[:place] + (values.bytes(count) if count > 0 else b"")
            seen = (begun + line[place - min(count, 0) :])[:size]
            heard = np.frombuffer(seen, dtype=READ_TYPE)
            good = bool(plausible(heard)[0])
            assert not good or heard[0] == block, place
            refused += not good
    assert refused > 400 * (size - 3)


def test_values_of_an_answer_cut_short_are_refused_whatever_its_crc() -> None:
    size = READ_TYPE.itemsize
    sent = blocks(200)
    for block, following in pairwise(sent):
        for servo in (1, 2, 252):
            ahead = encode_status(servo, 0, following.tobytes())
            for place in range(size):
                heard = np.frombuffer((block.tobytes()[:place] + ahead)[:size], dtype=READ_TYPE)
                assert not plausible(heard)[0], place


def test_a_damaged_tail_is_refused_though_its_crc_fits() -> None:
    values = np.random.default_rng(7)
    for block in blocks(2000):
        for spoilt in range(1, 6):
            tail = values.bytes(spoilt)
            data = block.tobytes()[:-spoilt] + tail
            assert not believed(encode_status(IDS[0], 0, data)) or data == block.tobytes()


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
