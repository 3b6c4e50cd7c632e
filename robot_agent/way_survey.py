"""Whether straight legs of a mission lead over ground that the robot can not walk, by its own map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan, degrees, hypot, tan

import numpy as np
from numpy.typing import NDArray

from robot_agent.ground_memory import GroundMemory
from robot_agent.navigation.keep_out import Area, hit
from weaver_shared.config.navigation import RouteConfig
from weaver_shared.config.safety import SafetyLimits
from weaver_shared.messages import Waypoint
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

STEP = 0.04
"""m between samples; a step is looked for between samples up to two apart, as in the route planner's cells."""

PLACES_OF_A_STEP = 12
"""Fewer in a metre of way are a wrong match, not an edge: one wrong sample makes nine places."""

SLOPE_LENGTH = 0.8
"""m of way over which a slope is taken: the stance of the robot, so that single steps and blocks are no slope."""

LEAST_RISE = 0.3
"""Of the rise that the slope makes over such a piece: no plane fitted to less, on half of the piece, is as steep."""

LEAST_KNOWN = 0.5
"""Share of such a piece that must be known."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Survey:
    refusal: str  # the first thing found, with its leg and place; empty when there is none
    length: float  # m of all legs
    unknown: float  # m of them over ground of which the map knows less than half

    @property
    def remark(self) -> str:
        """What the operator should know of a way that is allowed; empty when all of it is known."""
        if self.unknown < 0.1:
            return ""
        return f"{self.unknown:.1f} m of the {self.length:.1f} m of way lead over ground that the map does not know"


NOTHING_ASKED = Survey(refusal="", length=0.0, unknown=0.0)


class WaySurvey:
    def __init__(self, robot: RobotDescription, ground: GroundMemory) -> None:
        self._ground = ground
        self._half_width = robot.half_width
        self._highest_step = RouteConfig().highest_step
        self._steepest = SafetyLimits().tilt_hold  # rad; there it would hold, and not go on

    def survey(
        self, begin: tuple[float, float], waypoints: Sequence[Waypoint], first: int, areas: Sequence[Area] = ()
    ) -> Survey:
        """Legs from world `begin` (m) through `waypoints`, the first of which has number `first`; none may lead into
        the forbidden `areas`."""
        length = unknown = 0.0
        x, y = begin
        for number, waypoint in enumerate(waypoints, start=first):
            leg = hypot(waypoint.x - x, waypoint.y - y)
            if (area := hit(areas, (x, y), (waypoint.x, waypoint.y), self._half_width)) is not None:
                refusal = (
                    f"the way to waypoint {number} leads into forbidden area {area}; the feet need "
                    f"{self._half_width:.2f} m on either side of it"
                )
                return Survey(refusal=refusal, length=length, unknown=0.0)
            if leg > STEP:
                places, heights = self._strip((x, y), (waypoint.x, waypoint.y), leg)
                near = np.hypot(places[..., 0] - begin[0], places[..., 1] - begin[1]) < self._half_width
                heights[near] = np.nan  # where the robot stands it may walk, however near an edge is
                found = self._step(places, heights) or self._slope(places, heights)
                if found:
                    return Survey(
                        refusal=f"the way to waypoint {number} leads over {found}", length=length, unknown=0.0
                    )
                dark = np.isfinite(heights).mean(axis=1) < LEAST_KNOWN
                unknown += leg * float((dark & ~near.any(axis=1)).mean())
                length += leg
            x, y = waypoint.x, waypoint.y
        return Survey(refusal="", length=length, unknown=unknown)

    def _strip(self, begin: tuple[float, float], end: tuple[float, float], leg: float) -> tuple[Array, Array]:
        """World places (along, across, 2) of the strip that the feet need, and their heights (along, across), m."""
        ahead = np.array([end[0] - begin[0], end[1] - begin[1]]) / leg
        along = np.linspace(0.0, leg, max(round(leg / STEP), 1) + 1)
        across = np.linspace(-self._half_width, self._half_width, 2 * round(self._half_width / STEP) + 1)
        left = np.array([-ahead[1], ahead[0]])
        places: Array = np.array(begin) + along[:, None, None] * ahead + across[:, None] * left
        return places, self._ground.heights(places[..., 0], places[..., 1])

    def _step(self, places: Array, heights: Array) -> str:
        rows, columns = heights.shape
        if rows < 3:
            return ""
        lowest, highest = np.full((rows - 2, columns - 2), np.inf), np.full((rows - 2, columns - 2), -np.inf)
        for i in range(3):
            for j in range(3):
                part = heights[i : rows - 2 + i, j : columns - 2 + j]
                lowest, highest = np.fmin(lowest, part), np.fmax(highest, part)
        high = highest - lowest > self._highest_step
        metre = round(1.0 / STEP)
        for row in np.flatnonzero(high.any(axis=1)):
            if high[row : row + metre].sum() < PLACES_OF_A_STEP:
                continue
            column = int(np.flatnonzero(high[row])[0])
            step = float((highest - lowest)[row : row + metre][high[row : row + metre]].max())
            return (
                f"a step of {step:.2f} m {_at(places[row + 1, column + 1])}; "
                f"the highest that the robot is sent over is {self._highest_step:.2f} m"
            )
        return ""

    def _slope(self, places: Array, heights: Array) -> str:
        window = round(SLOPE_LENGTH / STEP)
        for row in range(0, max(len(heights) - window, 0) + 1, window // 4):
            part, z = places[row : row + window], heights[row : row + window]
            known = np.isfinite(z)
            if len(z) < window or known.mean() < LEAST_KNOWN:
                continue
            if np.ptp(z[known]) < LEAST_RISE * tan(self._steepest) * SLOPE_LENGTH:
                continue
            middle = part[known].mean(axis=0)
            slope, *_ = np.linalg.lstsq(part[known] - middle, z[known] - z[known].mean(), rcond=None)
            if hypot(*slope) > tan(self._steepest):
                return (
                    f"ground {degrees(atan(hypot(*slope))):.0f} degrees steep {_at(middle)}; "
                    f"the steepest that the robot is sent over is {degrees(self._steepest):.0f} degrees"
                )
        return ""


def _at(place: Array) -> str:
    return f"at x {place[0]:.2f} m, y {place[1]:.2f} m"
