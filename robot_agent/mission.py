"""The operator's mission: a list of waypoints and how far the robot has come along it."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, isfinite, nan

import numpy as np

from weaver_shared.config.command import CommandLimits
from weaver_shared.messages import Command, CommandName, MissionState, Waypoint

WAYS = ("", "auto")

AT_HOME = 0.15
"""m from the start within which there is nothing to return to: a little more than a last waypoint is reached to."""


class Mission:
    """Phases: empty -> ready -> active <-> paused -> done. Changing the waypoints leaves an active mission paused."""

    def __init__(self, limits: CommandLimits) -> None:
        self._limits = limits
        self.waypoints: tuple[Waypoint, ...] = ()
        self.phase = "empty"
        self.serial = 0
        self.find_way = False  # waypoints are goals, ways between them are found over the map
        self._next = 0
        self._first = 0  # waypoints before it are behind the robot or were skipped: the way walked begins at this one
        self._reached: tuple[Waypoint, ...] = ()  # since the mission began, in order: known to be a way back
        self._home = Waypoint(x=0.0, y=0.0)
        self._returning = False
        self._cross_track_error = 0.0
        self._distance_left = 0.0
        self._lookahead = np.full(2, nan)

    @property
    def home(self) -> Waypoint:
        """Where the mission began; before the first one the origin, where the robot's own world begins."""
        return self._home

    @property
    def walked(self) -> tuple[Waypoint, ...]:
        """The waypoints that are walked through: without those that were skipped."""
        return self.waypoints[self._first :]

    @property
    def ahead(self) -> tuple[Waypoint, ...]:
        """The waypoints still to come."""
        return self.waypoints[self._next :]

    def straight_way(self, command: Command) -> tuple[Waypoint, ...]:
        """The waypoints that this command would have the robot walk to in straight lines, if any."""
        if command.command is CommandName.START_MISSION and self.phase in ("ready", "paused"):
            way = self.ahead
        elif command.command is CommandName.SKIP_WAYPOINT and self.phase in ("active", "paused"):
            way = self.waypoints[self._next + 1 :]
        elif command.command is CommandName.SET_MISSION and self.phase == "active" and not command.name:
            way = command.waypoints[self._next :]
        elif command.command is CommandName.RETURN_TO_START:
            way = self.way_home()
        elif command.command is CommandName.SET_AREAS and self.phase == "active":
            way = self.ahead
        else:
            return ()
        return () if self.find_way else way

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
        self._returning = False
        self._begin()
        return ""

    def start(self, robot_xy: tuple[float, float]) -> str:
        """Begin, or go on after a pause; returns why not, or an empty string."""
        if not self.waypoints:
            return "there is no waypoint to walk to; add one first"
        if self.phase == "done":
            return "the mission is done; set new waypoints first"
        if self.phase == "ready":
            self._begin()
            self._home, self._reached = Waypoint(x=robot_xy[0], y=robot_xy[1]), ()
        self.phase = "active"
        return ""

    def skip(self) -> str:
        """Leave out the waypoint being approached; returns why not, or an empty string."""
        if self.phase not in ("active", "paused"):
            return "no mission is under way, so there is no waypoint to skip"
        if self._next + 1 >= len(self.waypoints):
            self.finish()
            return ""
        self.serial += 1
        self._first = self._next = self._next + 1
        return ""

    def way_home(self) -> tuple[Waypoint, ...]:
        """Back through the waypoints already reached, which the robot knows to be a way, unless it finds its own."""
        if self._returning:
            return self.ahead or (self._home,)
        return (*(() if self.find_way else self._reached[::-1]), self._home)

    def turn_back(self, robot_xy: tuple[float, float]) -> str:
        """Walk back to where the mission began; returns why not, or an empty string."""
        home = self._home
        if hypot(home.x - robot_xy[0], home.y - robot_xy[1]) < AT_HOME:
            return f"the robot is at the start already (x {home.x:.2f} m, y {home.y:.2f} m)"
        self.waypoints = self.way_home()
        self._begin()
        self._returning, self._reached = True, ()
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
        """Take how far the follower is; `index` counts the waypoints that are `walked`."""
        index = min(self._first + max(index, 0), len(self.waypoints))
        self._reached += self.waypoints[self._next : index]
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
        self._next = self._first = 0
        self._cross_track_error = 0.0
        self._distance_left = 0.0
        self._lookahead = np.full(2, nan)
