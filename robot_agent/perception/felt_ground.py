"""Roughness and step height as the feet feel them, for when the cameras are not to be trusted.

Footholds scatter about their plane as the ground does, so their standard deviation stands for the root mean square
residual f2 of eqs. 7 and 8, and the other features for what a normal law of that deviation would give. Edges and
surface area can not be felt.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.perception.features import (
    HALF_NORMAL_MEAN,
    PERCENTILE_98,
    SPREAD_5_95,
    Roughness,
    roughness_of,
    step_height_of,
)
from robot_agent.perception.ground_plane import fit_plane
from weaver_shared.config.perception import FeatureConfig, FeltConfig

Array = NDArray[np.float64]


class FeltGround:
    """Judges the ground by the feet that stand and by where they stood in the last strides."""

    def __init__(self, config: FeltConfig, features: FeatureConfig) -> None:
        self._config = config
        self._features = features
        self._stamps: list[int] = []
        self._points: list[Array] = []  # left behind
        self._standing = np.zeros((0, 3))  # (legs, 3), NaN of feet that do not stand

    def step(self, standing: Array, place: Array, stamp_ns: int) -> Roughness:
        """Judge the ground about `place` (at least x, y); `standing` (legs, 3) are the feet that stand, NaN the others.

        All in world, m. NaN if unknown.
        """
        self._leave_behind(standing, stamp_ns)
        self._forget(place, stamp_ns)
        firm = standing[np.isfinite(standing).all(axis=1)]
        points = np.concatenate([np.reshape(self._points, (-1, 3)), firm])
        if len(points) < self._config.fewest:
            return Roughness.unknown()
        x, y, z = points.T
        try:
            plane = fit_plane(x, y, z, "paper")
        except ValueError:  # all on one line
            return Roughness.unknown()
        free = len(points) - 3
        deviation = float(np.sqrt((plane.residual(x, y, z) ** 2).sum() / free))
        return self._judge(deviation, 1.0 / np.sqrt(2.0 * free))

    def _judge(self, deviation: float, relative: float) -> Roughness:
        config, features = self._config, self._features
        level = float(np.sqrt(max(0.0, deviation**2 - config.noise**2)))
        normal = np.array([HALF_NORMAL_MEAN, 1.0, SPREAD_5_95, 0.0, 0.0, PERCENTILE_98, 0.0])
        roughness = roughness_of(level * normal, features)
        step_height = step_height_of(level * normal, features)
        # What the feet's own noise leaves, and the few of them.
        left_over = 0.5 * config.noise * normal
        return Roughness(
            roughness=roughness,
            roughness_sigma=min(1.0, relative * roughness + roughness_of(left_over, features)),
            step_height=step_height,
            step_height_sigma=min(1.0, relative * step_height + step_height_of(left_over, features)),
        )

    def _leave_behind(self, standing: Array, stamp_ns: int) -> None:
        """Feet that stood and stand no more have left their last place to memory."""
        if len(self._standing):
            left = np.isfinite(self._standing).all(axis=1) & ~np.isfinite(standing).all(axis=1)
            self._stamps += [stamp_ns] * int(left.sum())
            self._points += list(self._standing[left])
        self._standing = standing

    def _forget(self, place: Array, stamp_ns: int) -> None:
        kept = [
            k
            for k, (stamp, point) in enumerate(zip(self._stamps, self._points, strict=True))
            if (stamp_ns - stamp) * 1e-9 <= self._config.memory
            and np.hypot(point[0] - place[0], point[1] - place[1]) <= self._config.radius
        ]
        self._stamps = [self._stamps[k] for k in kept]
        self._points = [self._points[k] for k in kept]
