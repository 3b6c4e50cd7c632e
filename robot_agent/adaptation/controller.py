"""From the worst ground under the feet to calm gait parameters (ICRA'17 III-E)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from robot_agent.adaptation.polynomials import PARAMETERS, gait_for, safe_gait
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.messages import AdaptationReport, GaitParameters, TerrainEstimate


class WorstGround(Protocol):
    """What the map says of the circle about the body; 0..1, NaN unknown."""

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

    def step(self, worst: WorstGround, ahead: TerrainEstimate, stamp_ns: int, dt: float) -> AdaptationReport:
        """Parameters for now; `dt` s since the last call. `applied` equals `desired`: overrides come later.

        Unknown ground gives the rough end, and pictures of low health the whole safe gait.
        """
        config = self._config
        self._roughness = _with_backlash(self._roughness, worst.roughness, config.backlash)
        self._step_height = _with_backlash(self._step_height, worst.step_height, config.backlash)
        self._health += (ahead.health - self._health) * (1.0 - math.exp(-dt / config.health_time))
        trusted = self._health >= config.smallest_health and not math.isnan(worst.roughness)
        wanted = gait_for(self._roughness, self._step_height, config) if trusted else safe_gait(config)
        for name in PARAMETERS:
            self._values[name] = rate_limited(self._values[name], wanted[name], getattr(config, name).rate * dt)
        parameters = GaitParameters(
            stamp_ns=stamp_ns, confidence=self._confidence(worst) if trusted else 0.0, **self._values
        )
        return AdaptationReport(
            stamp_ns=stamp_ns,
            roughness=worst.roughness,
            roughness_sigma=worst.roughness_sigma,
            step_height=worst.step_height,
            step_height_sigma=worst.step_height_sigma,
            ahead_roughness=ahead.roughness,
            ahead_step_height=ahead.step_height,
            source="vision" if trusted else "none",
            desired=parameters,
            applied=parameters,
            overridden=(),
        )

    def unknown(self, stamp_ns: int, dt: float) -> AdaptationReport:
        """Parameters on their way to the safe gait, for when nothing is known of the ground at all."""
        return self.step(_Unknown(), _unseen(stamp_ns), stamp_ns, dt)

    def _confidence(self, worst: WorstGround) -> float:
        sigma = max(worst.roughness_sigma, worst.step_height_sigma)
        known = 0.0 if math.isnan(sigma) else max(0.0, 1.0 - sigma / self._config.full_sigma)
        return min(1.0, self._health) * known


@dataclass(frozen=True, slots=True)
class _Unknown:
    roughness: float = math.nan
    roughness_sigma: float = math.nan
    step_height: float = math.nan
    step_height_sigma: float = math.nan


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
