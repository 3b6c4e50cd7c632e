"""Compilation of kernels, as in `robot_agent.kinematics.compiled`, which navigation has no business with."""

from collections.abc import Callable
from typing import TypeVar, cast

from numba import njit

F = TypeVar("F", bound=Callable[..., object])


def kernel(function: F) -> F:
    """`njit` with a cache, keeping the function's types; a division by zero gives infinity, as in numpy."""
    return cast(F, njit(cache=True, error_model="numpy")(function))
