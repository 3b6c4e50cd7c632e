"""Follows routes that are found anew under way, goal by goal; stands still and says why when there is none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import hypot

import numpy as np

from robot_agent.navigation.keep_out import Area, hit
from robot_agent.navigation.path_follower import FollowerOutput, PathFollower
from weaver_shared.config.navigation import PathFollowerConfig, RouteConfig
from weaver_shared.messages import NavigationGoal, RoutePlan, Waypoint
from weaver_shared.transforms import Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteTick:
    goal: NavigationGoal  # a way to it is asked for
    follower: FollowerOutput  # its index counts goals, as that of a mission does
    waiting: str  # why the robot does not walk; empty when it does
    hopeless: bool  # there has been no way for longer than patience lasts


class RouteFollower:
    """One mission at a time, told from others by its serial number."""

    def __init__(self, config: RouteConfig | None = None, *, half_width: float = 0.0) -> None:
        """The feet are set within `half_width` (m) of the way."""
        self._half_width = half_width
        self._judged: tuple[int, tuple[Area, ...]] | None = None  # a route's revision, and by which areas
        self._area: int | None = None  # that the route leads into
        self._config = config = config or RouteConfig()
        self._follower = PathFollower(config.follower)
        self._between = PathFollowerConfig().acceptance_radius  # of goals that are only passed
        self._serial = -1
        self._goal = 0
        self._revision = -1
        self._path: tuple[Waypoint, ...] = ()
        self._index = 1
        self._lost_ns: int | None = None

    def step(
        self,
        world_from_body: Pose,
        goals: Sequence[Waypoint],
        serial: int,
        route: RoutePlan | None,
        stamp_ns: int,
        areas: tuple[Area, ...] = (),
    ) -> RouteTick:
        """One tick along the newest `route`, unless it leads into one of `areas`; `goals` may not be empty."""
        here = Waypoint(x=float(world_from_body.position[0]), y=float(world_from_body.position[1]))
        if serial != self._serial:
            self._serial, self._goal, self._revision, self._path, self._lost_ns = serial, 0, -1, (), None
        self._goal = min(self._goal, len(goals) - 1)
        while self._goal < len(goals) - 1 and _distance(here, goals[self._goal]) < self._between:
            self._goal, self._path = self._goal + 1, ()
        place = goals[self._goal]
        asked = NavigationGoal(stamp_ns=stamp_ns, serial=serial, active=True, place=place)
        waiting = self._take(route, place, here, stamp_ns, areas)
        if waiting:
            return self._still(asked, waiting, stamp_ns)
        self._lost_ns = None
        follower = self._follower.step(world_from_body, self._path, self._index)
        self._index = follower.index
        done = follower.done and self._goal == len(goals) - 1
        return RouteTick(
            goal=asked,
            follower=replace(follower, index=len(goals) if done else self._goal, done=done),
            waiting="",
            hopeless=False,
        )

    def _take(
        self, route: RoutePlan | None, place: Waypoint, here: Waypoint, stamp_ns: int, areas: tuple[Area, ...]
    ) -> str:
        """Take a new route; returns why there is nothing to follow, or an empty string."""
        if route is None or route.serial != self._serial or route.goal != place:
            return "looking for a way"
        if (stamp_ns - route.stamp_ns) * 1e-9 > self._config.lifetime:
            return "the map is not being looked at: no way is known"
        if not route.found:
            return f"no way: {route.reason}"
        if self._judged != (route.revision, areas):
            self._judged, self._area = (route.revision, areas), self._entered(route, here, areas)
        if self._area is not None:
            return f"no way: the one that was found leads into forbidden area {self._area}"
        if route.revision != self._revision or not self._path:
            self._revision = route.revision
            self._path, self._index = (here, *route.waypoints), 1
        return ""

    def _entered(self, route: RoutePlan, here: Waypoint, areas: tuple[Area, ...]) -> int | None:
        """The first forbidden area that the rest of a route comes into."""
        behind = self._index - 1 if self._path and route.revision == self._revision else 0
        legs = pairwise(((here.x, here.y), *((place.x, place.y) for place in route.waypoints[behind:])))
        found = (hit(areas, begin, end, self._half_width) for begin, end in legs)
        return next((number for number in found if number is not None), None)

    def _still(self, asked: NavigationGoal, waiting: str, stamp_ns: int) -> RouteTick:
        self._path = ()
        if not waiting.startswith("no way"):
            self._lost_ns = None
        elif self._lost_ns is None:
            self._lost_ns = stamp_ns
        lost_for = 0.0 if self._lost_ns is None else (stamp_ns - self._lost_ns) * 1e-9
        return RouteTick(
            goal=asked,
            follower=FollowerOutput(
                velocity=np.zeros(3),
                index=self._goal,
                cross_track_error=0.0,
                distance_left=float("nan"),
                done=False,
                lookahead_in_world=np.full(2, np.nan),
            ),
            waiting=waiting,
            hopeless=lost_for > self._config.patience,
        )


def _distance(one: Waypoint, other: Waypoint) -> float:
    return hypot(one.x - other.x, one.y - other.y)
