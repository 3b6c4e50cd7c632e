"""From joints at rest to the walking stance, all legs at once (OpenSHC's direct start-up, facts 3.14)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.body_pose import BodyPose
from robot_agent.locomotion.openshc.configuration import Configuration
from robot_agent.locomotion.openshc.extended import Extended, ExtendedLegs
from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.transitions import COMPLETE, JointMove, TipMove, ticks_of

Array = NDArray[np.float64]

DOWN = np.array([0.0, 0.0, -1.0])


class DirectStartUp:
    """Joints move to where the solver ends when it leads each tip to its stance."""

    def __init__(self, description: Configuration, legs: Sequence[Leg], pose: BodyPose) -> None:
        targets = standing_joints(description, legs, pose)
        self._moves = [
            JointMove(leg, target, description.time_to_start, description.time_delta)
            for leg, target in zip(legs, targets, strict=True)
        ]

    def tick(self) -> int:
        """Progress in per cent."""
        return [move.tick() for move in self._moves][-1]


def standing_joints(description: Configuration, legs: Sequence[Leg], pose: BodyPose) -> list[Array]:
    """Angles (n,) a leg in which they stand under a body that has risen to `pose`."""
    if description.gravity_aligned_tips:
        return [_aligned_joints(description, leg, pose) for leg in legs]
    result: dict[int, Array] = {}
    for count in {len(leg.description.joints) for leg in legs}:
        alike = [k for k, leg in enumerate(legs) if len(leg.description.joints) == count]
        found = _joints_of_alike([legs[k] for k in alike], description, pose)
        result |= dict(zip(alike, found.astype(np.float64), strict=True))
    return [result[k] for k in range(len(legs))]


def _joints_of_alike(legs: Sequence[Leg], description: Configuration, pose: BodyPose) -> NDArray[Any]:
    """Of legs with equally many joints, (legs, n)."""
    trial = ExtendedLegs(legs, description.time_delta)
    origin, target = trial.tips(), np.array([leg.description.place for leg in legs], dtype=Extended)
    half = (origin + target) / 2
    up = [origin, origin, origin, (3 * origin + target) / 4, half]
    down = [half, (origin + 3 * target) / 4, target, target, target]
    ticks = ticks_of(description.time_to_start, description.time_delta)
    rise = np.asarray(pose.position, dtype=Extended)
    for tick in range(1, ticks + 1):
        first = tick <= ticks // 2
        t = Extended(2 * (tick if first else tick - ticks // 2)) / ticks
        share = Extended(tick - 1) / ticks
        risen = (6 * share**5 - 15 * share**4 + 10 * share**3) * rise
        trial.step_to(_quartic(up if first else down, t) - risen)
    return trial.position


def _quartic(nodes: Sequence[NDArray[Any]], t: Any) -> NDArray[Any]:
    s = 1 - t
    weights = (s**4, 4 * s**3 * t, 6 * s**2 * t**2, 4 * s * t**3, t**4)
    point: NDArray[Any] = np.add.reduce([weight * node for weight, node in zip(weights, nodes, strict=True)])
    return point


def _aligned_joints(description: Configuration, leg: Leg, pose: BodyPose) -> Array:
    """Of one leg whose tip turns downwards on the way."""
    trial = Leg(leg.description, description.time_delta, clamp_rate=False)
    frame = trial.tip_frame()
    move = TipMove(
        frame[:3, 3].copy(),
        frame[:3, 0].copy(),
        leg.description.place,
        pose=pose,
        lift=0.0,
        seconds=description.time_to_start,
        dt=description.time_delta,
        direction=DOWN,
    )
    progress = 0
    while progress != COMPLETE:
        progress = move.tick()
        trial.step_to(move.tip, move.direction)
    return trial.position
