"""Feeds the parsers of the robot's serial lines with records of which half are damaged, and counts what they believe.

Wrong is a value that was believed and is not what was sent. A check of 16 bits lets one in 65 536 of the damages pass
that it does not find for certain, so the parsers look at the values too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

import numpy as np

from robot_agent.hardware.servos.group_answer import GroupAnswer
from robot_agent.hardware.servos.health_block import READ_TYPE, plausible
from robot_agent.hardware.servos.packet import encode_status
from sim_agent.wire_noise import KINDS, damaged

GROUP = 5
"""Servos that answer one after the other, as those of a leg do."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FuzzCount:
    damaged: int
    wrong: int  # believed and not what was sent
    sound: int  # records left alone
    sound_lost: int  # of these, not believed: damage in front of them hid them


def fuzz_servos(records: int, seed: int) -> FuzzCount:
    """Damage so many answers to cyclic reads."""
    generator = Random(seed)
    values = np.random.default_rng(seed)
    ids = list(range(1, GROUP + 1))
    group = GroupAnswer(ids, READ_TYPE.itemsize)
    names = np.array(ids, dtype=np.uint8)
    spoilt = wrong = sound = lost = 0
    while spoilt < records:
        sent = _blocks(names, values)
        group.begin()
        hit = []
        for servo, block in zip(ids, sent, strict=True):
            wire = encode_status(servo, 0, block.tobytes())
            hit.append(generator.random() < 0.5)
            group.feed(damaged(wire, generator.choice(KINDS), generator) if hit[-1] else wire)
        valid = group.finish()
        got = group.data.view(READ_TYPE)[:, 0]
        believed = valid & plausible(got, names)
        was_hit = np.array(hit)
        wrong += int(np.sum(believed & ((got != sent) | (group.error != 0))))
        spoilt += int(was_hit.sum())
        sound += int((~was_hit).sum())
        lost += int(np.sum(~was_hit & ~believed))
    return FuzzCount(damaged=spoilt, wrong=wrong, sound=sound, sound_lost=lost)


FUZZES: dict[str, Callable[[int, int], FuzzCount]] = {"servo": fuzz_servos}


def _blocks(ids: np.ndarray, values: np.random.Generator) -> np.ndarray:
    """What healthy servos in motion answer, READ_TYPE (n,)."""
    blocks = np.zeros(ids.size, dtype=READ_TYPE)
    blocks["id"] = ids
    blocks["torque_on"] = 1
    blocks["watchdog"] = 10
    blocks["current"] = values.integers(-900, 900, ids.size)
    blocks["velocity"] = values.integers(-200, 200, ids.size)
    blocks["position"] = values.integers(0, 4096, ids.size)
    blocks["voltage"] = values.integers(140, 150, ids.size)
    blocks["temperature"] = values.integers(25, 60, ids.size)
    return blocks
