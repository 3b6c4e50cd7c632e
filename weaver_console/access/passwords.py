"""Passwords as they are kept: salted and hashed by scrypt, with its costs beside them so that these may rise later."""

from __future__ import annotations

import base64
import hashlib
import hmac
import secrets
from functools import cache

from weaver_shared.errors import InputError

SHORTEST, LONGEST = 8, 256
COST, BLOCK, PARALLEL = 2**14, 8, 1
"""16 MB and some 50 ms a guess, as RFC 7914 advises for logging in."""


def hashed(password: str) -> str:
    """`scrypt$cost$block$parallel$salt$hash`. Raises InputError on a password too short or too long to be one."""
    if not SHORTEST <= len(password) <= LONGEST:
        raise InputError(f"a password has {SHORTEST} to {LONGEST} characters")
    salt = secrets.token_bytes(16)
    digest = _scrypt(password, salt, COST, BLOCK, PARALLEL)
    return "$".join(["scrypt", str(COST), str(BLOCK), str(PARALLEL), _text(salt), _text(digest)])


def matches(password: str, kept: str) -> bool:
    _, cost, block, parallel, salt, digest = kept.split("$")
    found = _scrypt(password[:LONGEST], _bytes(salt), int(cost), int(block), int(parallel))
    return hmac.compare_digest(found, _bytes(digest))


@cache
def nobodys() -> str:
    """Compared with where there is no such user, so that the time taken does not tell."""
    return hashed(secrets.token_hex(16))


def _scrypt(password: str, salt: bytes, cost: int, block: int, parallel: int) -> bytes:
    memory = 2 * 128 * cost * block * parallel
    data = password.encode("utf-8", "surrogatepass")
    return hashlib.scrypt(data, salt=salt, n=cost, r=block, p=parallel, maxmem=memory, dklen=32)


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def _bytes(text: str) -> bytes:
    return base64.b64decode(text)
