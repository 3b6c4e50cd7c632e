"""How the odometry's kernels are compiled: cached on disk, without the GIL, and never raising on a division."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Kernel = TypeVar("Kernel", bound=Callable[..., Any])


def compiled(function: Kernel) -> Kernel:
    return cast(Kernel, numba.njit(cache=True, nogil=True, error_model="numpy")(function))


def compiled_for_speed(function: Kernel) -> Kernel:
    """As `compiled`, with fused and reordered sums; what depends on NaN and infinity keeps its meaning."""
    return cast(
        Kernel,
        numba.njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz"})(function),
    )
