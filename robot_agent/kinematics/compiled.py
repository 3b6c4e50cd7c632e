"""Compilation of kernels: machine code is kept beside the source, so a second start does not compile."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import TypeVar, cast

from numba import njit
from numba.core.dispatcher import Dispatcher

F = TypeVar("F", bound=Callable[..., object])

_sources: dict[object, str] = {}
"""By kernel: digest of the source it was compiled from."""


def kernel(function: F) -> F:
    """`njit` with a cache, keeping the function's types; a division by zero gives infinity, as in numpy.

    numba compiles a cached kernel anew when its own file changes, and misses a change in the kernels that it calls in
    other files. So the stamp of the cache is a digest of the file and of all kernels the file imports.
    """
    compiled = njit(cache=True, error_model="numpy")(function)
    if compiled is function:  # numba is switched off, for debugging
        return function
    imported = {_sources[value] for value in function.__globals__.values() if _is_kernel(value)}
    own = _digest_of_file(inspect.getfile(function))
    digest = sha256("".join([own, *sorted(imported)]).encode()).hexdigest()
    _sources[compiled] = digest
    compiled._cache._cache_file._source_stamp = digest
    return cast(F, compiled)


def _is_kernel(value: object) -> bool:
    return isinstance(value, Dispatcher) and value in _sources


@cache
def _digest_of_file(path: str) -> str:
    return sha256(Path(path).read_bytes()).hexdigest()
