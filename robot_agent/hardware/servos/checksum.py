"""CRC-16 of Dynamixel Protocol 2.0: polynomial 0x8005, first bit first, beginning with 0, nothing inverted.

The polynomial is (x + 1)(x^15 + x + 1), so every damage of one, two or three bits, of any odd number of bits, and
of a single burst up to 16 bits long is found for certain; of all other damage one in 65 536 passes. Bits count in the
CRC's order, highest first; a line sends the lowest first, and what is 16 bits long there may be 24 here.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

POLYNOMIAL = 0x8005
LONG = 64
"""Bytes from which on a look-up of all at once is faster."""


def _remainder(byte: int) -> int:
    value = byte << 8
    for _ in range(8):
        value = (value << 1) ^ POLYNOMIAL if value & 0x8000 else value << 1
    return value & 0xFFFF


_TABLE = [_remainder(byte) for byte in range(256)]


def crc16(data: bytes, start: int = 0) -> int:
    if len(data) >= LONG and not start:
        return int(crc16_of_rows(np.frombuffer(data, dtype=np.uint8)[np.newaxis])[0])
    value = start
    for byte in data:
        value = ((value << 8) & 0xFFFF) ^ _TABLE[(value >> 8) ^ byte]
    return value


def crc16_of_rows(rows: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """CRCs (n,) of n messages of the same length, `rows` (n, length).

    A CRC that begins with 0 is linear: the message's is the exclusive or of those of its bytes, each followed by
    zeros. One table per place makes that a look-up for all messages at once.
    """
    tables = _tables_by_place(rows.shape[1])
    terms = tables[np.arange(rows.shape[1]), rows]
    result: NDArray[np.uint16] = np.bitwise_xor.reduce(terms, axis=1)
    return result


@lru_cache(maxsize=32)
def _tables_by_place(length: int) -> NDArray[np.uint16]:
    """CRC of each byte value at each place of a message, (length, 256)."""
    table = np.array(_TABLE, dtype=np.uint16)
    tables = np.empty((length, 256), dtype=np.uint16)
    tables[length - 1 :] = table
    for place in range(length - 2, -1, -1):
        after = tables[place + 1]
        tables[place] = (after << 8) ^ table[after >> 8]
    return tables
