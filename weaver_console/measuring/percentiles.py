"""Delays summed up as the figures that people compare."""

from collections.abc import Sequence

import numpy as np


def percentiles_ms(delays: Sequence[float], *wanted: int) -> dict[str, float | None]:
    """`{"p50": ...}` in ms of delays in s; None where nothing was measured."""
    figures: dict[str, float | None] = {"count": len(delays)}
    for share in wanted:
        figures[f"p{share}"] = round(float(np.percentile(delays, share)) * 1e3, 2) if delays else None
    return figures
