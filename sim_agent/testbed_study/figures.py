"""What the walks amount to: cost of transport, sway, speed and success, by segment and over all (eqs. 12 and 13)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_agent.testbed_study.plan import KINDS
from sim_agent.testbed_study.walk import WalkRecord
from sim_agent.worlds import World
from weaver_shared.frames import GRAVITY

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class KindFigures:
    """Over all walks of one kind; means with standard deviations over the walks that reached the end."""

    walks: int
    reached: int
    cost_total: tuple[float, float]  # whole supply, as in Weaver's paper
    cost_motors: tuple[float, float]  # motors alone, as in OpenSHC's
    speed: tuple[float, float]  # m/s
    duration: tuple[float, float]  # s
    drift_percent: tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentFigures:
    """Adaptive against fixed on one stretch; costs and speeds as (adaptive, fixed), reductions in %."""

    cost_total: tuple[float, float]
    cost_motors: tuple[float, float]
    speed: tuple[float, float]  # m/s
    cost_reduction: float  # of the total
    roll_reduction: float  # of the variance
    pitch_reduction: float


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyFigures:
    kinds: dict[str, KindFigures]
    segments: dict[str, SegmentFigures]
    cost_reduction: float  # % of the total cost of transport over the course
    motor_cost_reduction: float


def study_figures(records: list[WalkRecord], world: World, mass: float) -> StudyFigures:
    """Figures of all `records`; NaN where a kind has no walk that reached the end."""
    finished: dict[str, list[WalkRecord]] = {
        kind: [r for r in records if r.plan.kind == kind and r.outcome == "reached"] for kind in KINDS
    }
    kinds = {
        kind: KindFigures(
            walks=sum(record.plan.kind == kind for record in records),
            reached=len(walks),
            cost_total=_mean([_cost(record.rows, "supply_power", mass) for record in walks]),
            cost_motors=_mean([_cost(record.rows, "motor_power", mass) for record in walks]),
            speed=_mean([_speed(record.rows) for record in walks]),
            duration=_mean([record.duration for record in walks]),
            drift_percent=_mean([record.drift_percent for record in walks]),
        )
        for kind, walks in finished.items()
    }
    segments = {}
    for segment in world.segments:
        parts = {
            kind: [part for record in walks if len((part := _within(record.rows, segment.begin, segment.end))["x"]) > 2]
            for kind, walks in finished.items()
        }
        if all(parts.values()):
            segments[segment.name] = _segment(parts, mass)
    return StudyFigures(
        kinds=kinds,
        segments=segments,
        cost_reduction=_reduction(*(kinds[kind].cost_total[0] for kind in KINDS)),
        motor_cost_reduction=_reduction(*(kinds[kind].cost_motors[0] for kind in KINDS)),
    )


def _segment(parts: dict[str, list[dict[str, Array]]], mass: float) -> SegmentFigures:
    def pair(value: str) -> tuple[float, float]:
        adaptive, fixed = (_mean([_cost(part, value, mass) for part in parts[kind]])[0] for kind in KINDS)
        return adaptive, fixed

    def variance_reduction(angle: str) -> float:
        """Variances about each walk's own mean on the stretch, averaged: a slope is no sway."""
        return _reduction(*(float(np.mean([np.var(part[angle]) for part in parts[kind]])) for kind in KINDS))

    total = pair("supply_power")
    adaptive, fixed = (_mean([_speed(part) for part in parts[kind]])[0] for kind in KINDS)
    return SegmentFigures(
        cost_total=total,
        cost_motors=pair("motor_power"),
        speed=(adaptive, fixed),
        cost_reduction=_reduction(*total),
        roll_reduction=variance_reduction("roll"),
        pitch_reduction=variance_reduction("pitch"),
    )


def _within(rows: dict[str, Array], begin: float, end: float) -> dict[str, Array]:
    """Rows between the first and the last that lie on the stretch."""
    inside = np.flatnonzero((rows["x"] >= begin) & (rows["x"] < end))
    part = slice(int(inside[0]), int(inside[-1]) + 1) if len(inside) else slice(0, 0)
    return {name: column[part] for name, column in rows.items()}


def _cost(rows: dict[str, Array], power: str, mass: float) -> float:
    """Mean power over weight and mean speed along the course (eq. 12)."""
    return float(rows[power].mean() / (mass * GRAVITY * _speed(rows)))


def _speed(rows: dict[str, Array]) -> float:
    return float((rows["x"][-1] - rows["x"][0]) / (rows["time"][-1] - rows["time"][0]))


def _reduction(adaptive: float, fixed: float) -> float:
    """Percent by which the adaptive value is smaller (eq. 13)."""
    return 100.0 * (1.0 - adaptive / fixed) if fixed else float("nan")


def _mean(values: list[float]) -> tuple[float, float]:
    if not values:
        return float("nan"), float("nan")
    return float(np.mean(values)), float(np.std(values))
