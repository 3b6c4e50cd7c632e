"""From the worst ground under the feet to calm gait parameters (ICRA'17 III-E)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from robot_agent.adaptation.polynomials import PARAMETERS, gait_for, safe_gait
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.messages import AdaptationReport, GaitParameters, TerrainEstimate


class Ground(Protocol):
    """What the map says of the circle about the body, or the feet of where they stood; 0..1, NaN unknown."""

    @property
    def roughness(self) -> float: ...
    @property
    def roughness_sigma(self) -> float: ...
    @property
    def step_height(self) -> float: ...
    @property
    def step_height_sigma(self) -> float: ...


class AdaptationController:
    """Polynomials, backlash and rate limits. Starts at the safe end, where a robot that has seen nothing belongs."""

    def __init__(self, config: AdaptationConfig = AdaptationConfig()) -> None:  # noqa: B008
        self._config = config
        self._roughness = 1.0
        self._step_height = 1.0
        self._health = 0.0
        self._values = safe_gait(config)

    def step(
        self, worst: Ground, ahead: TerrainEstimate, stamp_ns: int, dt: float, felt: Ground | None = None
    ) -> AdaptationReport:
        """Parameters for now; `dt` s since the last call. `applied` equals `desired`: overrides come later.

        Pictures of low health leave the ground to the feet, who know where they were and not where they go: their
        figures count with one standard deviation more. Good pictures of what lies `ahead` join them where the ground
        under the robot was never seen, as at the start; the worse of the two counts. Ground unknown to both gives the
        whole safe gait.
        """
        config = self._config
        self._health += (ahead.health - self._health) * (1.0 - math.exp(-dt / config.health_time))
        source, ground = self._rule(worst, ahead, felt)
        self._roughness = _with_backlash(self._roughness, ground.roughness, config.backlash)
        self._step_height = _with_backlash(self._step_height, ground.step_height, config.backlash)
        known = source != "none"
        wanted = gait_for(self._roughness, self._step_height, config) if known else safe_gait(config)
        for name in PARAMETERS:
            self._values[name] = rate_limited(self._values[name], wanted[name], getattr(config, name).rate * dt)
        parameters = GaitParameters(
            stamp_ns=stamp_ns, confidence=self._confidence(ground, source) if known else 0.0, **self._values
        )
        return AdaptationReport(
            stamp_ns=stamp_ns,
            roughness=ground.roughness,
            roughness_sigma=ground.roughness_sigma,
            step_height=ground.step_height,
            step_height_sigma=ground.step_height_sigma,
            ahead_roughness=ahead.roughness,
            ahead_step_height=ahead.step_height,
            source=source,
            desired=parameters,
            applied=parameters,
            overridden=(),
            perception=ahead.mode,
        )

    def _rule(self, worst: Ground, ahead: TerrainEstimate, felt: Ground | None) -> tuple[str, Ground]:
        """Who knows the ground, and what they say of it."""
        sighted = self._health >= self._config.smallest_health
        if sighted and not math.isnan(worst.roughness):
            return "vision", worst
        if felt is None or math.isnan(felt.roughness) or (sighted and math.isnan(ahead.roughness)):
            return "none", worst
        under = _with_doubt(felt)
        return "feet", _worse_of(under, _with_doubt(ahead)) if sighted else under

    def unknown(self, stamp_ns: int, dt: float) -> AdaptationReport:
        """Parameters on their way to the safe gait, for when nothing is known of the ground at all."""
        return self.step(_Indices(), _unseen(stamp_ns), stamp_ns, dt)

    def _confidence(self, ground: Ground, source: str) -> float:
        """0..1; feet speak of what is behind the robot, so at most half."""
        sigma = max(ground.roughness_sigma, ground.step_height_sigma)
        known = 0.0 if math.isnan(sigma) else max(0.0, 1.0 - sigma / self._config.full_sigma)
        return (min(1.0, self._health) if source == "vision" else 0.5) * known


@dataclass(frozen=True, slots=True)
class _Indices:
    roughness: float = math.nan
    roughness_sigma: float = math.nan
    step_height: float = math.nan
    step_height_sigma: float = math.nan


def _with_doubt(ground: Ground) -> _Indices:
    """Its figures with one standard deviation more."""
    return _Indices(
        min(1.0, ground.roughness + ground.roughness_sigma),
        ground.roughness_sigma,
        min(1.0, ground.step_height + ground.step_height_sigma),
        ground.step_height_sigma,
    )


def _worse_of(one: _Indices, other: _Indices) -> _Indices:
    rougher = max(one, other, key=lambda ground: ground.roughness)
    higher = max(one, other, key=lambda ground: ground.step_height)
    return _Indices(rougher.roughness, rougher.roughness_sigma, higher.step_height, higher.step_height_sigma)


def _unseen(stamp_ns: int) -> TerrainEstimate:
    return TerrainEstimate(
        stamp_ns=stamp_ns,
        roughness=math.nan,
        roughness_sigma=math.nan,
        step_height=math.nan,
        step_height_sigma=math.nan,
        features=np.full(7, np.nan),
        plane_normal_in_world=np.array([0.0, 0.0, 1.0]),
        health=0.0,
        reason="nothing was seen",
    )


def rate_limited(value: float, wanted: float, largest_step: float) -> float:
    return value + min(max(wanted - value, -largest_step), largest_step)


def _with_backlash(held: float, measured: float, backlash: float) -> float:
    """Rises at once, falls only by what exceeds the backlash; near nothing it lets go, so that flat is flat."""
    if math.isnan(measured):
        return 1.0
    if measured < backlash:
        return measured
    return min(max(held, measured), measured + backlash)
