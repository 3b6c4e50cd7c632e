"""The best gait of a ground: what its trials cost and swayed, weighed into one score, and the mean of the good ones."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_agent.fit_study.trial import TrialResult

Array = NDArray[np.float64]
Parameters = tuple[float, float, float]
"""Virtual stiffness (N/m), stride frequency (Hz) and stride height (m)."""

SWAY = np.deg2rad(3.0)
"""Root mean square of roll and pitch together at which a walk counts as twice as costly."""
GOOD = 0.05
"""Of the best score: sets worse by this weigh 1/e in the mean."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BestGait:
    """Of one ground with its true `roughness` and `step_height`. Sets are (stiffness N/m, frequency Hz, height m)."""

    ground: str
    roughness: float
    step_height: float
    sets: int
    passed: int  # sets that reached the end with every seed
    parameters: Parameters  # mean of the good sets; NaN where none passed
    spread: Parameters  # their standard deviation
    score: float  # lowest
    lowest: Parameters  # the set with that score
    cost_total: float  # of it, as the next two
    sway_deg: float
    speed: float  # m/s
    fastest: Parameters  # what speed alone, the paper's measure, would choose
    fastest_speed: float


def score(cost: float, variance: float) -> float:
    """Total cost of transport, raised by the body's sway (rad^2, roll and pitch together)."""
    return float(cost * (1.0 + variance / SWAY**2))


def best_gait(ground: str, indices: tuple[float, float], results: Iterable[TrialResult]) -> BestGait:
    """Weigh the sets of one ground; a set that failed with any seed is out."""
    by_set: dict[Parameters, list[TrialResult]] = {}
    for result in results:
        by_set.setdefault(result.trial.parameters, []).append(result)
    passed = {values: runs for values, runs in by_set.items() if all(run.outcome == "reached" for run in runs)}
    if not passed:
        return _none_passed(ground, indices, len(by_set))
    sets = np.array(list(passed))
    figures = np.array([_means(runs) for runs in passed.values()])
    scores = figures[:, 0]
    weights = np.exp(-(scores / scores.min() - 1.0) / GOOD)
    weights /= weights.sum()
    mean = weights @ sets
    spread = np.sqrt(weights @ (sets - mean) ** 2)
    chosen, fastest = int(scores.argmin()), int(figures[:, 3].argmax())
    return BestGait(
        ground=ground,
        roughness=indices[0],
        step_height=indices[1],
        sets=len(by_set),
        passed=len(passed),
        parameters=_triple(mean),
        spread=_triple(spread),
        score=float(scores[chosen]),
        lowest=_triple(sets[chosen]),
        cost_total=float(figures[chosen, 1]),
        sway_deg=float(np.rad2deg(np.sqrt(figures[chosen, 2]))),
        speed=float(figures[chosen, 3]),
        fastest=_triple(sets[fastest]),
        fastest_speed=float(figures[fastest, 3]),
    )


def _means(runs: list[TrialResult]) -> tuple[float, float, float, float]:
    """Score, total cost, variance and speed, over the seeds."""
    rows = [(run.cost_total, run.roll_variance + run.pitch_variance, run.speed) for run in runs]
    cost, variance, speed = (float(value) for value in np.mean(rows, axis=0))
    return score(cost, variance), cost, variance, speed


def _none_passed(ground: str, indices: tuple[float, float], sets: int) -> BestGait:
    nothing = float("nan")
    unknown = (nothing, nothing, nothing)
    return BestGait(
        ground=ground,
        roughness=indices[0],
        step_height=indices[1],
        sets=sets,
        passed=0,
        parameters=unknown,
        spread=unknown,
        score=nothing,
        lowest=unknown,
        cost_total=nothing,
        sway_deg=nothing,
        speed=nothing,
        fastest=unknown,
        fastest_speed=nothing,
    )


def _triple(values: Array) -> Parameters:
    first, second, third = (float(value) for value in values)
    return first, second, third
