"""What a bad serial line does to a record on its way."""

from __future__ import annotations

from random import Random

KINDS = ("bits", "burst", "byte", "lost", "inserted", "cut")
"""1 to 3 flipped bits, up to 16 bits in a row, one byte, 1 to 3 bytes lost, 1 to 3 inserted, the end missing."""

ONE_PLACE = ("byte", "lost", "inserted", "cut")
"""What happens at one place of a record. Two damaged bytes can cancel each other out in a mere sum of bytes."""


def damaged(record: bytes, kind: str, generator: Random) -> bytes:
    """A record that differs from `record` by one of KINDS."""
    spoil = {
        "bits": _flip_bits,
        "burst": _flip_burst,
        "byte": _replace_byte,
        "lost": _lose,
        "inserted": _insert,
        "cut": _cut,
    }[kind]
    return spoil(record, generator)


def _flip_bits(record: bytes, generator: Random) -> bytes:
    spoilt = bytearray(record)
    for place in generator.sample(range(8 * len(record)), generator.randint(1, 3)):
        spoilt[place // 8] ^= 1 << place % 8
    return bytes(spoilt)


def _flip_burst(record: bytes, generator: Random) -> bytes:
    pattern = generator.randrange(1, 1 << 16) << generator.randrange(8 * len(record) - 15)
    value = int.from_bytes(record, "little") ^ pattern
    return value.to_bytes(len(record), "little")


def _replace_byte(record: bytes, generator: Random) -> bytes:
    spoilt = bytearray(record)
    spoilt[generator.randrange(len(record))] ^= generator.randrange(1, 256)
    return bytes(spoilt)


def _lose(record: bytes, generator: Random) -> bytes:
    count = generator.randint(1, 3)
    start = generator.randrange(len(record) - count + 1)
    return record[:start] + record[start + count :]


def _insert(record: bytes, generator: Random) -> bytes:
    start = generator.randrange(1, len(record))
    return record[:start] + generator.randbytes(generator.randint(1, 3)) + record[start:]


def _cut(record: bytes, generator: Random) -> bytes:
    return record[: generator.randrange(len(record))]
