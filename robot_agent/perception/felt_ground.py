"""Roughness and step height as feet, joints and body feel them, for when the cameras are not to be trusted.

Footholds scatter about their plane as the ground does, so their standard deviation stands for the root mean square
residual f2 of eqs. 7 and 8, and the other features for what a normal law of that deviation would give. Edges and
surface area can not be felt. Uneven ground also changes the load of a leg and the tilt of the body from stride to
stride, beyond what the gait explains; both are weighed in as the deviation of heights that goes with them.
"""

from __future__ import annotations

from dataclasses import dataclass

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
from robot_agent.perception.felt_strides import StrideChanges
from robot_agent.perception.ground_plane import fit_plane
from weaver_shared.config.perception import FeatureConfig, FeltConfig
from weaver_shared.leg_batch import LegBatch
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.foot_loads import foot_loads
from weaver_shared.transforms import Pose, rotation_z

Array = NDArray[np.float64]

NORMAL = np.array([HALF_NORMAL_MEAN, 1.0, SPREAD_5_95, 0.0, 0.0, PERCENTILE_98, 0.0])
"""The features of heights of unit deviation."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BodySense:
    """What the body feels of the ground at one instant."""

    stamp_ns: int
    standing: Array  # (legs, 3) where feet stand in world, m; NaN of feet that do not, or whose place is unknown
    load: Array  # (legs,) N borne by feet that stand, NaN of the others
    tilt: Array  # (2,) rad, of the body forward and to the left
    place: Array  # (2,) or more: the body's x, y in world, m

    @staticmethod
    def of(
        robot: RobotDescription, legs: LegBatch, stamp_ns: int, world_from_body: Pose, standing: Array, *, placed: bool
    ) -> BodySense:
        """From the legs' last readings; `standing` as above, worth nothing unless the pose is known: `placed`."""
        load, stands = np.full(len(standing), np.nan), np.isfinite(standing).all(axis=1)
        if stands.any():
            up_in_body, torque = world_from_body.rotation[2], legs.joint_torque.mean(axis=0)
            load[stands] = foot_loads(robot, legs.joint_position[-1], torque, up_in_body)[stands]
        return BodySense(
            stamp_ns=stamp_ns,
            standing=standing if placed else np.full_like(standing, np.nan),
            load=load,
            tilt=(rotation_z(-world_from_body.yaw) @ world_from_body.rotation[:, 2])[:2],
            place=world_from_body.position,
        )


class FeltGround:
    """Judges the ground by the feet that stand, where they stood, what they bore and how the body swayed."""

    def __init__(self, config: FeltConfig, features: FeatureConfig) -> None:
        self._config = config
        self._features = features
        self._stamps: list[int] = []
        self._points: list[Array] = []  # left behind
        self._standing = np.zeros((0, 3))  # (legs, 3), NaN of feet that do not stand
        self._changes: StrideChanges | None = None

    def step(self, sense: BodySense) -> Roughness:
        """The ground about the body; NaN if there are too few footholds."""
        if self._changes is None:
            self._changes = StrideChanges(len(sense.load), self._config.strides)
        self._changes.step(sense.load, sense.tilt)
        self._leave_behind(sense.standing, sense.stamp_ns)
        self._forget(sense.place, sense.stamp_ns)
        firm = sense.standing[np.isfinite(sense.standing).all(axis=1)]
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
        level = float(np.sqrt(max(0.0, deviation**2 - self._config.noise**2)))
        return self._judge(level, 1.0 / np.sqrt(2.0 * free), self._changes)

    def _judge(self, level: float, relative: float, changes: StrideChanges) -> Roughness:
        """From the deviation (m) of the footholds, known to a share `relative`, and what changed between strides."""
        config, features = self._config, self._features
        load = config.load_gain * max(0.0, changes.load_change - config.load_noise)
        tilt = config.tilt_gain * max(0.0, changes.tilt_change - config.tilt_noise)
        told = np.array([level, load, tilt])
        known = np.array([True, np.isfinite(changes.load_change), np.isfinite(changes.tilt_change)])
        weights = np.array(config.weights)[known] / np.array(config.weights)[known].sum()
        mean = float(weights @ told[known])
        # How the three disagree, what the feet's own noise leaves, and the few of them.
        apart = float(np.sqrt(weights @ (told[known] - mean) ** 2)) if known.sum() > 1 else 0.0
        doubt = (max(relative * mean, apart) + 0.5 * config.noise) * NORMAL
        return Roughness(
            roughness=roughness_of(mean * NORMAL, features),
            roughness_sigma=min(1.0, roughness_of(doubt, features)),
            step_height=step_height_of(mean * NORMAL, features),
            step_height_sigma=min(1.0, step_height_of(doubt, features)),
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
