"""The operator's mission: a list of waypoints and how far the robot has come along it."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, isfinite, nan

import numpy as np

from weaver_shared.config.command import CommandLimits
from weaver_shared.messages import MissionState, Waypoint

WAYS = ("", "auto")


class Mission:
    """Phases: empty -> ready -> active <-> paused -> done. Changing the waypoints leaves an active mission paused."""

    def __init__(self, limits: CommandLimits) -> None:
        self._limits = limits
        self.waypoints: tuple[Waypoint, ...] = ()
        self.phase = "empty"
        self.serial = 0
        self.find_way = False  # waypoints are goals, ways between them are found over the map
        self._next = 0
        self._cross_track_error = 0.0
        self._distance_left = 0.0
        self._lookahead = np.full(2, nan)

    def replace(self, waypoints: Sequence[Waypoint], robot_xy: tuple[float, float], how: str = "") -> str:
        """Take new waypoints; returns why they are refused, or an empty string.

        `how` is "auto" for goals to which the robot finds its way around obstacles, or empty for straight lines.
        """
        if how not in WAYS:
            return f"a mission is walked auto or, with no name, straight; {how!r:.40} is neither"
        if len(waypoints) > self._limits.waypoint_count:
            return f"{len(waypoints)} waypoints; at most {self._limits.waypoint_count} are possible"
        for number, waypoint in enumerate(waypoints, start=1):
            if not (isfinite(waypoint.x) and isfinite(waypoint.y)):
                return f"waypoint {number} is not a place: x and y must be finite numbers in metres"
            distance = hypot(waypoint.x - robot_xy[0], waypoint.y - robot_xy[1])
            if distance > self._limits.waypoint_reach:
                return (
                    f"waypoint {number} is {distance:.0f} m from the robot; the farthest allowed is "
                    f"{self._limits.waypoint_reach:.0f} m"
                )
        same_way = self.find_way == bool(how)
        self.find_way = bool(how)
        if (
            same_way
            and waypoints
            and self.phase == "active"
            and tuple(waypoints[: self._next]) == self.waypoints[: self._next]
        ):
            self.waypoints = tuple(waypoints)
            if self._next >= len(self.waypoints):
                self.finish()
            return ""
        self.waypoints = tuple(waypoints)
        self.phase = "ready" if waypoints else "empty"
        self._begin()
        return ""

    def start(self) -> str:
        """Begin, or go on after a pause; returns why not, or an empty string."""
        if not self.waypoints:
            return "there is no waypoint to walk to; add one first"
        if self.phase == "done":
            return "the mission is done; set new waypoints first"
        if self.phase == "ready":
            self._begin()
        self.phase = "active"
        return ""

    def pause(self) -> None:
        if self.phase == "active":
            self.phase = "paused"

    def finish(self) -> None:
        self.phase = "done"
        self._next = len(self.waypoints)
        self._distance_left = 0.0
        self._lookahead = np.full(2, nan)

    def progress(self, *, index: int, cross_track_error: float, distance_left: float, lookahead: np.ndarray) -> None:
        self._next = index
        self._cross_track_error = cross_track_error
        self._distance_left = distance_left
        self._lookahead = np.asarray(lookahead, dtype=np.float64)[:2]

    def state(self, stamp_ns: int) -> MissionState:
        return MissionState(
            stamp_ns=stamp_ns,
            phase=self.phase,
            waypoints=self.waypoints,
            next_waypoint=self._next,
            cross_track_error=self._cross_track_error,
            distance_left=self._distance_left,
            lookahead_in_world=self._lookahead,
        )

    def _begin(self) -> None:
        self.serial += 1
        self._next = 0
        self._cross_track_error = 0.0
        self._distance_left = 0.0
        self._lookahead = np.full(2, nan)
