"""One Kalman filter a cell, with a gate against outliers and a way back when the ground really changed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray


class FusionRules(NamedTuple):
    """Standard deviations in m, `drift` in m per square root of a second."""

    gate: float
    slack: float
    rejections: int
    floor: float
    drift: float
    ceiling: float


class Extent(NamedTuple):
    """World cells row..row_end, column..column_end (ends exclusive) that changed; empty if row_end <= row."""

    row: int
    column: int
    row_end: int
    column_end: int


def joined(a: Extent, b: Extent) -> Extent:
    """The smallest extent that holds both."""
    if a.row_end <= a.row:
        return b
    if b.row_end <= b.row:
        return a
    return Extent(
        min(a.row, b.row), min(a.column, b.column), max(a.row_end, b.row_end), max(a.column_end, b.column_end)
    )


@njit(cache=True)
def predicted_variance(variance: float, seconds: float, rules: FusionRules) -> float:
    """A cell not seen for a while is less certain, up to the ceiling: it is kept, never forgotten."""
    return min(variance + rules.drift * rules.drift * seconds, max(variance, rules.ceiling * rules.ceiling))


@njit(cache=True)
def fuse(
    measured: NDArray[np.float32],
    measured_variance: NDArray[np.float32],
    row0: int,
    column0: int,
    window_row: int,
    window_column: int,
    elevation: NDArray[np.float32],
    variance: NDArray[np.float32],
    rejected: NDArray[np.uint8],
    accepted: NDArray[np.uint8],
    seen_ns: NDArray[np.int64],
    stamp_ns: int,
    rules: FusionRules,
) -> Extent:
    """Merge measured heights (n, n), whose first cell is world cell (row0, column0), into the map's layers.

    The layers are stored modulo their size; `window_row` and `window_column` say where the window begins. A height far
    off the map's is believed once it was `rejected` in a row as often as others were `accepted`, at most
    `rules.rejections` times.
    """
    size = elevation.shape[0]
    floor = rules.floor * rules.floor
    first_row, first_column, last_row, last_column = 1 << 30, 1 << 30, -(1 << 30), -(1 << 30)
    for i in range(measured.shape[0]):
        row = row0 + i
        if row < window_row or row >= window_row + size:
            continue
        r = row % size
        for j in range(measured.shape[1]):
            z = measured[i, j]
            column = column0 + j
            if np.isnan(z) or column < window_column or column >= window_column + size:
                continue
            c = column % size
            noise = max(measured_variance[i, j], floor)
            old = elevation[r, c]
            if np.isnan(old):
                elevation[r, c], variance[r, c], rejected[r, c], accepted[r, c] = z, noise, 0, 1
            else:
                seconds = max(0.0, (stamp_ns - seen_ns[r, c]) * 1e-9)
                prior = predicted_variance(variance[r, c], seconds, rules)
                innovation = z - old
                if abs(innovation) > rules.slack + rules.gate * np.sqrt(prior + noise):
                    rejected[r, c] += 1
                    if rejected[r, c] < min(rules.rejections, accepted[r, c]):
                        continue
                    elevation[r, c], variance[r, c], rejected[r, c], accepted[r, c] = z, noise, 0, 1
                else:
                    gain = prior / (prior + noise)
                    elevation[r, c] = old + gain * innovation
                    variance[r, c] = max(floor, (1.0 - gain) * prior)
                    rejected[r, c] = 0
                    accepted[r, c] = min(accepted[r, c] + 1, 255)
            seen_ns[r, c] = stamp_ns
            first_row, last_row = min(first_row, row), max(last_row, row)
            first_column, last_column = min(first_column, column), max(last_column, column)
    return Extent(first_row, first_column, last_row + 1, last_column + 1)
