"""A robot's postures: a walker for each, and the way from one into the other (OpenSHC'20 VI-B)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.leg_reach import LegReach
from robot_agent.locomotion.posture_plan import plan_change
from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from robot_agent.locomotion.walker import Walker
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.counterpart import counterpart_of

Array = NDArray[np.float64]


class Postures:
    """Stands in for the walker of the posture the robot is in; a robot with one posture has just that walker."""

    def __init__(self, robot: RobotDescription, dt: float) -> None:
        other = counterpart_of(robot)
        self._robots = (robot,) if other is None else (robot, other)
        self._walkers = tuple(Walker(one, dt=dt) for one in self._robots)
        self._models = tuple(LegModel.of_robot(one) for one in self._robots)
        self._plans = () if other is None else (plan_change(robot, other), plan_change(other, robot))
        self._now = 0
        self._serial = 0

    @property
    def name(self) -> str:
        """Of the posture the legs are in; empty for a robot with one only."""
        posture = self._robots[self._now].posture
        return posture.name if posture is not None else ""

    @property
    def leg_reach(self) -> LegReach:
        """Where the legs may put their feet in the posture they are in."""
        return self._walkers[self._now].leg_reach

    def reset(self, joint_position: Array) -> None:
        """Begin from where the joints are, sitting; the posture is the last one that the legs were in."""
        self._walkers[self._now].reset(joint_position)

    def begin_standing(self) -> Array:
        """Be standing at once; returns the joint angles (joints,) that this means."""
        return self._walkers[self._now].begin_standing()

    def step(self, sensed: WalkInput) -> WalkOutput:
        """One control tick."""
        walker = self._walkers[self._now]
        if sensed.posture_order.serial != self._serial:
            self._serial = sensed.posture_order.serial
            self._begin(sensed.posture_order.name)
        if self._now > 0:
            sensed = sensed._replace(parameters=_within(sensed.parameters, self._robots[self._now].adaptation))
        out = walker.step(sensed)
        if not self._plans:
            return out
        out = out._replace(leg_posture=self.name, change_refusal=walker.change_refusal)
        if walker.changed:
            self._now = 1 - self._now
            self._walkers[self._now].take_over(walker)
        return out

    def _begin(self, name: str) -> None:
        walker = self._walkers[self._now]
        other = self._robots[1 - self._now].posture if self._plans else None
        if other is not None and name == other.name and not walker.change_refusal:
            walker.begin_change(self._models[1 - self._now], self._plans[self._now])


def _within(parameters: GaitParameters, bounds: AdaptationConfig) -> GaitParameters:
    """Parameters chosen for the robot's other posture, within what this one allows."""
    height, frequency = bounds.stride_height, bounds.stride_frequency
    return replace(
        parameters,
        stride_height=float(np.clip(parameters.stride_height, height.lower, height.upper)),
        stride_frequency=float(np.clip(parameters.stride_frequency, frequency.lower, frequency.upper)),
    )
