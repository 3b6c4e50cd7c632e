"""Keeps what a hand or a cruise steers out of forbidden areas, and says so once each time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.navigation import Area, AreaFence
from robot_agent.navigation.keep_out import Fenced
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    velocity: Array | None  # (3,), None when nothing was asked for
    halted: bool = False
    news: str = ""  # for the operator; empty when there is nothing new


class AreaKeeper:
    def __init__(self, robot: RobotDescription) -> None:
        self._fence = AreaFence(robot.foot_circle, robot.half_width)
        self._told = 0  # number of the area before which it has stopped

    def keep_out(
        self, areas: Sequence[Area], asked: Array | None, place: tuple[float, float], world_from_body: Pose | None
    ) -> Kept:
        """As much of a body velocity (3,) as leads into none of the areas from world `place`, m."""
        if asked is None or not areas:
            self._told = 0
            return Kept(velocity=asked)
        fenced = self._limit(areas, asked, place, world_from_body)
        news = _sentence(fenced.area) if fenced.halted and fenced.area != self._told else ""
        if fenced.halted or not fenced.area:
            self._told = fenced.area
        return Kept(velocity=fenced.velocity, halted=fenced.halted, news=news)

    def refusal(
        self, areas: Sequence[Area], asked: Array | None, place: tuple[float, float], world_from_body: Pose | None
    ) -> str:
        """Why this can not even be begun; empty when it can."""
        if asked is None or not areas:
            return ""
        fenced = self._limit(areas, asked, place, world_from_body)
        return _sentence(fenced.area) if fenced.halted else ""

    def _limit(
        self, areas: Sequence[Area], asked: Array, place: tuple[float, float], world_from_body: Pose | None
    ) -> Fenced:
        ahead = np.array([1.0, 0.0]) if world_from_body is None else world_from_body.rotation[:2, 0]
        return self._fence.limit(areas, asked, np.array(place), ahead / max(float(np.hypot(*ahead)), 1e-9))


def _sentence(area: int) -> str:
    return (
        f"the robot stops before forbidden area {area}, into which its feet would come; steer away from it, or along "
        "it, or take the area back"
    )
