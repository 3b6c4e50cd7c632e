"""Closer to the best: the sets halfway between the best one of a ground and its neighbours on the grid."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from sim_agent.fit_study.best import Parameters
from sim_agent.fit_study.plan import Trial

ROUNDS = 2
"""Each halves the distance of the values tried about the best set."""


def halfway(best: Parameters, tried: Iterable[Parameters]) -> list[Parameters]:
    """Sets that differ from `best` in one parameter, which lies halfway to the next value tried of it."""
    found = []
    for k, values in enumerate(np.array(sorted(tried)).T):
        for side in (values[values < best[k]], values[values > best[k]]):
            if len(side):
                nearest = float(side[np.argmin(np.abs(side - best[k]))])
                middle = np.sqrt(best[k] * nearest) if k == 0 else 0.5 * (best[k] + nearest)  # stiffness: equal ratios
                moved = list(best)
                moved[k] = float(f"{middle:.3g}")
                found.append((moved[0], moved[1], moved[2]))
    return found


def refined(best: Parameters, trials: list[Trial]) -> list[Trial]:
    """What to walk next on the ground of `trials`, with each of their seeds; nothing where no set passed."""
    if not np.isfinite(best).all():
        return []
    known = {trial.parameters for trial in trials}
    return [
        replace(trial, virtual_stiffness=c, stride_frequency=f, stride_height=h)
        for trial in {trial.seed: trial for trial in trials}.values()
        for c, f, h in halfway(best, known)
    ]
