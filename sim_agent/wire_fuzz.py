"""Feeds the parsers of the robot's serial lines with records of which half are damaged, and counts what they believe.

Wrong is a value that was believed and is not what was sent. A check of 16 bits lets one in 65 536 of the damages pass
that it does not find for certain, so the parsers look at the values too. The IMUs' checks are mere sums, in which two
damaged bytes can cancel each other out: against those nothing but luck helps, and they are counted only on demand.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random

import numpy as np

from robot_agent.hardware.imu.gx3 import Gx3Parser
from robot_agent.hardware.imu.mip import MipParser
from robot_agent.hardware.imu.record import STANDARD_GRAVITY, InertialRecord
from robot_agent.hardware.imu.stream import Z_DOWN
from robot_agent.hardware.power_monitor import SEQUENCES, PowerParser, PowerRecord, encode
from robot_agent.hardware.servos.group_answer import GroupAnswer
from robot_agent.hardware.servos.health_block import READ_TYPE, plausible
from robot_agent.hardware.servos.packet import encode_status
from robot_agent.hardware.servos.registers import ANSWERS_ALL
from sim_agent.sensor_lines import EmulatedGx3, EmulatedGx5
from sim_agent.wire_noise import KINDS, ONE_PLACE, damaged

GROUP = 5
"""Servos that answer one after the other, as those of a leg do."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FuzzCount:
    damaged: int
    wrong: int  # believed and not what was sent
    sound: int  # records left alone
    sound_lost: int  # of these, not believed: damage in front of them hid them


def fuzz_servos(records: int, seed: int, kinds: Sequence[str] = KINDS) -> FuzzCount:
    """Damage so many answers to cyclic reads."""
    generator = Random(seed)
    values = np.random.default_rng(seed)
    ids = list(range(1, GROUP + 1))
    group = GroupAnswer(ids, READ_TYPE.itemsize)
    spoilt = wrong = sound = lost = 0
    while spoilt < records:
        sent = answers_in_motion(len(ids), values)
        group.begin()
        hit = []
        for servo, block in zip(ids, sent, strict=True):
            wire = encode_status(servo, 0, block.tobytes())
            hit.append(generator.random() < 0.5)
            group.feed(damaged(wire, generator.choice(kinds), generator) if hit[-1] else wire)
        valid = group.finish()
        got = group.data.view(READ_TYPE)[:, 0]
        believed = valid & plausible(got)
        was_hit = np.array(hit)
        wrong += int(np.sum(believed & ((got != sent) | (group.error != 0))))
        spoilt += int(was_hit.sum())
        sound += int((~was_hit).sum())
        lost += int(np.sum(~was_hit & ~believed))
    return FuzzCount(damaged=spoilt, wrong=wrong, sound=sound, sound_lost=lost)


def fuzz_gx3(records: int, seed: int, kinds: Sequence[str] = ONE_PLACE) -> FuzzCount:
    """Damage so many records of a 3DM-GX3."""
    return _fuzz_imu(EmulatedGx3(), Gx3Parser(), records, seed, kinds)


def fuzz_mip(records: int, seed: int, kinds: Sequence[str] = ONE_PLACE) -> FuzzCount:
    """Damage so many packets of a 3DM-GX5."""
    return _fuzz_imu(EmulatedGx5(), MipParser(), records, seed, kinds)


def fuzz_power(records: int, seed: int, kinds: Sequence[str] = KINDS) -> FuzzCount:
    """Damage so many lines of the power monitor."""
    generator, parser = Random(seed), PowerParser()
    spoilt = sound = believed = wrong = 0
    sent: dict[int, PowerRecord] = {}
    sequence = 0
    while spoilt < records:
        sequence += 1
        record = PowerRecord(
            sequence % SEQUENCES, 11 * sequence, generator.randint(21_000, 29_400), generator.randint(0, 40_000), 7, 1
        )
        hit = generator.random() < 0.5
        if not hit:
            sent[record.sequence] = record
        sound, spoilt = sound + (not hit), spoilt + hit
        wire = encode(record)
        for got in parser.feed(damaged(wire, generator.choice(kinds), generator) if hit else wire):
            # A line with its damage before its first character is whole.
            right = got == sent.pop(got.sequence, None)
            believed += right
            wrong += not right and got != record
    return FuzzCount(damaged=spoilt, wrong=wrong, sound=sound, sound_lost=sound - believed)


FUZZES: dict[str, Callable[..., FuzzCount]] = {
    "servo": fuzz_servos,
    "gx3": fuzz_gx3,
    "mip": fuzz_mip,
    "power": fuzz_power,
}


def _fuzz_imu(
    device: EmulatedGx3 | EmulatedGx5, parser: Gx3Parser | MipParser, records: int, seed: int, kinds: Sequence[str]
) -> FuzzCount:
    generator, values = Random(seed), np.random.default_rng(seed)
    spoilt = sound = believed = wrong = 0
    sent: dict[int, tuple[bool, InertialRecord]] = {}
    stamp_ns = 0
    while spoilt < records:
        force, rate = np.array([0.0, 0.0, 9.8]) + values.normal(size=3), values.normal(size=3)
        for _ in range(16):
            stamp_ns += 10_000_000
            wire = device.record(stamp_ns, force, rate)
            hit = generator.random() < 0.5
            sound, spoilt = sound + (not hit), spoilt + hit
            sent[stamp_ns] = (hit, _as_sent(stamp_ns, force, rate))
            for got in parser.feed(damaged(wire, generator.choice(kinds), generator) if hit else wire):
                was_hit, original = sent.get(got.device_ns, (True, None))
                believed += not was_hit
                wrong += got != original
            sent.pop(stamp_ns - 64 * 10_000_000, None)
            force, rate = -force[::-1], 0.5 * rate[::-1]
    return FuzzCount(damaged=spoilt, wrong=wrong, sound=sound, sound_lost=sound - believed)


def _as_sent(stamp_ns: int, force: np.ndarray, rate: np.ndarray) -> InertialRecord:
    """What single precision leaves of a record, in the sensor's axes."""
    in_g = (Z_DOWN.T @ force / STANDARD_GRAVITY).astype(np.float32).astype(np.float64) * STANDARD_GRAVITY
    turning = (Z_DOWN.T @ rate).astype(np.float32).astype(np.float64)
    (fx, fy, fz), (wx, wy, wz) = map(float, in_g), map(float, turning)
    return InertialRecord(stamp_ns, (fx, fy, fz), (wx, wy, wz))


def answers_in_motion(count: int, values: np.random.Generator) -> np.ndarray:
    """What healthy servos in motion answer, READ_TYPE (count,)."""
    blocks = np.zeros(count, dtype=READ_TYPE)
    blocks["torque_on"] = 1
    blocks["watchdog"] = 10
    blocks["current"] = values.integers(-900, 900, count)
    blocks["velocity"] = values.integers(-200, 200, count)
    blocks["position"] = values.integers(0, 4096, count)
    blocks["voltage"] = values.integers(140, 150, count)
    blocks["temperature"] = values.integers(25, 60, count)
    blocks["return_level"] = ANSWERS_ALL
    return blocks
