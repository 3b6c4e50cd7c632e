"""A* over a grid of costs, eight ways from each cell, and the straightening of what it finds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.navigation.compiled import kernel

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Cells = NDArray[np.int64]

DIAGONAL = 1.4142135623730951


@kernel
def cheapest_path(cost: Array, barred: Flags, start: int, goal: int, parent: Cells) -> float:
    """Cost of the cheapest way, in cells times cost, infinite if there is none; costs are at least 1.

    Cells are numbered row * columns + column. `parent` (rows * columns,) is filled with where each cell is reached
    from. A diagonal step must not squeeze between two barred cells.
    """
    rows, columns = cost.shape
    reached = np.full(rows * columns, np.inf)
    closed = np.zeros(rows * columns, dtype=np.bool_)
    parent[:] = -1
    goal_r, goal_c = goal // columns, goal % columns
    keys, cells, count = np.empty(8 * rows * columns + 8), np.empty(8 * rows * columns + 8, dtype=np.int64), 0
    reached[start] = 0.0
    count = _push(keys, cells, count, _least(start // columns - goal_r, start % columns - goal_c), start)
    while count > 0:
        here = cells[0]
        count = _pop(keys, cells, count)
        if closed[here]:
            continue
        closed[here] = True
        if here == goal:
            return float(reached[goal])
        r, c = here // columns, here % columns
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                i, j = r + dr, c + dc
                if (dr == 0 and dc == 0) or i < 0 or j < 0 or i >= rows or j >= columns or barred[i, j]:
                    continue
                if dr != 0 and dc != 0 and (barred[i, c] or barred[r, j]):
                    continue
                length = DIAGONAL if dr != 0 and dc != 0 else 1.0
                total = reached[here] + 0.5 * length * (cost[r, c] + cost[i, j])
                there = i * columns + j
                if total < reached[there] - 1e-12:
                    reached[there] = total
                    parent[there] = here
                    count = _push(keys, cells, count, total + _least(i - goal_r, j - goal_c), there)
    return np.inf


@kernel
def _least(dr: int, dc: int) -> float:
    """Length of the shortest eight-way path over free ground, in cells."""
    long, short = max(abs(dr), abs(dc)), min(abs(dr), abs(dc))
    return long + (DIAGONAL - 1.0) * short


@kernel
def _push(keys: Array, cells: Cells, count: int, key: float, cell: int) -> int:
    place = count
    while place > 0 and keys[(place - 1) // 2] > key:
        keys[place], cells[place] = keys[(place - 1) // 2], cells[(place - 1) // 2]
        place = (place - 1) // 2
    keys[place], cells[place] = key, cell
    return count + 1


@kernel
def _pop(keys: Array, cells: Cells, count: int) -> int:
    """Remove the first; the last takes its place and sinks."""
    count -= 1
    key, cell = keys[count], cells[count]
    place = 0
    while True:
        child = 2 * place + 1
        if child >= count:
            break
        if child + 1 < count and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[place], cells[place] = keys[child], cells[child]
        place = child
    keys[place], cells[place] = key, cell
    return count


@kernel
def line_cost(cost: Array, barred: Flags, r0: float, c0: float, r1: float, c1: float) -> float:
    """Cost of walking straight between two places given in cells, infinite if anything barred or outside is met."""
    length = np.sqrt((r1 - r0) ** 2 + (c1 - c0) ** 2)
    steps = int(np.ceil(4.0 * length)) + 1
    total = 0.0
    for k in range(steps):
        share = (k + 0.5) / steps
        r, c = int(np.floor(r0 + share * (r1 - r0) + 0.5)), int(np.floor(c0 + share * (c1 - c0) + 0.5))
        if r < 0 or c < 0 or r >= cost.shape[0] or c >= cost.shape[1] or barred[r, c]:
            return np.inf
        total += cost[r, c]
    return float(total * length / steps)


@kernel
def straighten(cost: Array, barred: Flags, path: Cells, kept: Flags) -> None:
    """Mark in `kept` (n,) the turning points of `path` (n, 2), rows and columns, leaving out all that a straight line
    replaces at no more than a fiftieth of extra cost."""
    n = path.shape[0]
    along = np.zeros(n)
    for k in range(1, n):
        along[k] = along[k - 1] + line_cost(
            cost, barred, float(path[k - 1, 0]), float(path[k - 1, 1]), float(path[k, 0]), float(path[k, 1])
        )
    kept[:] = False
    kept[0] = kept[n - 1] = True
    here = 0
    while here < n - 1:
        there = n - 1
        while there > here + 1:
            straight = line_cost(
                cost, barred, float(path[here, 0]), float(path[here, 1]), float(path[there, 0]), float(path[there, 1])
            )
            if straight <= 1.02 * (along[there] - along[here]) + 1e-9:
                break
            there -= 1
        kept[there] = True
        here = there
