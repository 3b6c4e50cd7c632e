"""Readable operator names: `amber fox`, and a number behind a name that somebody else has."""

import random
import re
from collections.abc import Collection

from weaver_shared.errors import InputError

_COLOURS = ("amber", "azure", "coral", "ivory", "jade", "lilac", "ochre", "olive", "pearl", "ruby", "sand", "teal")
_ANIMALS = ("badger", "crane", "falcon", "fox", "heron", "ibis", "lynx", "marten", "otter", "raven", "stork", "wren")
_VALID = re.compile(r"[\w .\-]{1,40}")


def invent(taken: Collection[str], random_source: random.Random) -> str:
    return distinct(f"{random_source.choice(_COLOURS)} {random_source.choice(_ANIMALS)}", taken)


def distinct(name: str, taken: Collection[str]) -> str:
    """`name`, or with the first free number behind it."""
    if name not in taken:
        return name
    number = 2
    while f"{name} {number}" in taken:
        number += 1
    return f"{name} {number}"


def valid(name: str) -> str:
    """`name` without surrounding spaces. Raises InputError when it is not a name."""
    stripped = name.strip()
    if not _VALID.fullmatch(stripped):
        raise InputError("an operator's name has 1 to 40 letters, digits, spaces, '-', '_' or '.'")
    return stripped
