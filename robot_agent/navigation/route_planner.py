"""A way to a goal over the terrain map, looked for anew as the map grows (OpenSHC's auto navigation)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.navigation.clearance import add_clearance
from robot_agent.navigation.grid_search import cheapest_path, line_cost, straighten
from robot_agent.navigation.ground_costs import GroundCosts, GroundMap
from robot_agent.navigation.keep_out import Area, depths
from weaver_shared.config.navigation import RouteConfig
from weaver_shared.messages import NavigationGoal, RoutePlan, Waypoint
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]
Cell = tuple[int, int]

TIGHT = 20.0
"""What a cell costs more in which the robot can only be because it stands there."""


class RoutePlanner:
    """Keeps what it has learnt of the ground for as long as the goal is the same, and a route while it is as good."""

    def __init__(self, robot: RobotDescription, config: RouteConfig | None = None) -> None:
        self._config = config = config or RouteConfig()
        self._radius = robot.foot_circle + config.clearance
        self._goal: NavigationGoal | None = None
        self._costs: GroundCosts | None = None
        self._measured: tuple[tuple[Area, ...], GroundCosts, list[Array]] | None = None
        self._route: tuple[Waypoint, ...] = ()
        self._revision = 0

    def step(
        self, goal: NavigationGoal, ground: GroundMap, x: float, y: float, stamp_ns: int, areas: Sequence[Area] = ()
    ) -> RoutePlan:
        """The route from world (x, y) m to the goal over the ground as it is known now, around forbidden `areas`."""
        if self._costs is None or self._goal is None or (goal.serial, goal.place) != (
            self._goal.serial, self._goal.place
        ):  # fmt: skip
            self._costs = GroundCosts(self._config, np.array([[x, y], [goal.place.x, goal.place.y]]))
            self._route = ()
        self._goal = goal
        costs = self._costs
        costs.learn(ground)
        cost, barred = costs.cost.copy(), np.zeros_like(costs.blocked)
        config = self._config
        add_clearance(costs.blocked, costs.cell, self._radius, config.comfort, config.comfort_weight, cost, barred)
        start, end = costs.cell_of(x, y), costs.cell_of(goal.place.x, goal.place.y)
        if not _holds(cost, start):
            return self._nothing(stamp_ns, "the robot has left the area in which a way was looked for")
        _open_around(costs, barred, cost, start, self._radius)
        if forbidden := self._bar(areas, cost, barred, start, end):
            return self._nothing(
                stamp_ns, f"the goal is nearer than {self._radius:.2f} m to forbidden area {forbidden}"
            )
        if barred[end]:
            return self._nothing(stamp_ns, f"the goal is nearer than {self._radius:.2f} m to an obstacle")
        parent = np.empty(cost.size, dtype=np.int64)
        columns = cost.shape[1]
        found = cheapest_path(cost, barred, start[0] * columns + start[1], end[0] * columns + end[1], parent)
        if not np.isfinite(found):
            closing = "obstacles and forbidden areas close" if areas else "obstacles close"
            return self._nothing(stamp_ns, f"{closing} every way to the goal")
        if not self._still_good(cost, barred, (x, y), found):
            self._take(_cells(parent, end[0] * columns + end[1], columns), cost, barred)
        return self._plan(stamp_ns, x, y)

    def _bar(
        self,
        areas: Sequence[Area],
        cost: Array,
        barred: NDArray[np.bool_],
        start: tuple[int, int],
        end: tuple[int, int],
    ) -> int:
        """Bar what the feet's circle would share with an area; the number of one that holds the goal, 0 for none.

        A robot that stands in one may go where it comes no deeper, at a price: so it leaves by the shortest way.
        """
        for number, depth in enumerate(self._depths(areas), start=1):
            if depth[end] < self._radius:
                return number
            closed = min(self._radius, float(depth[start]) - 1e-6)
            barred |= depth < closed
            cost[depth < self._radius] += TIGHT
        return 0

    def _depths(self, areas: Sequence[Area]) -> list[Array]:
        """Distances (rows, columns) of the cells' middles from each area; worked out when areas or cells change."""
        assert self._costs is not None
        if self._measured is None or self._measured[:2] != (tuple(areas), self._costs):
            costs = self._costs
            rows, columns = np.indices(costs.cost.shape)
            middles = np.stack([rows + costs.row0 + 0.5, columns + costs.column0 + 0.5], axis=-1) * costs.cell
            found = [depths(area, middles.reshape(-1, 2)).reshape(rows.shape) for area in areas]
            self._measured = (tuple(areas), costs, found)
        return self._measured[2]

    def _still_good(self, cost: Array, barred: NDArray[np.bool_], here: tuple[float, float], found: float) -> bool:
        """Whether what is left of the present route costs hardly more than the best there is."""
        assert self._costs is not None
        self._drop_passed(here)
        if not self._route:
            return False
        total, (x, y) = 0.0, here
        for waypoint in self._route:
            total += line_cost(cost, barred, *self._in_cells(x, y), *self._in_cells(waypoint.x, waypoint.y))
            x, y = waypoint.x, waypoint.y
        return bool(total <= self._config.keep_factor * found)

    def _drop_passed(self, here: tuple[float, float]) -> None:
        while len(self._route) > 1:
            first, second = self._route[0], self._route[1]
            ahead = (first.x - here[0]) * (second.x - first.x) + (first.y - here[1]) * (second.y - first.y)
            near = np.hypot(first.x - here[0], first.y - here[1]) < self._config.follower.acceptance_radius
            if not (near or ahead < 0.0):
                break
            self._route = self._route[1:]

    def _take(self, path: NDArray[np.int64], cost: Array, barred: NDArray[np.bool_]) -> None:
        assert self._costs is not None
        assert self._goal is not None
        kept = np.zeros(len(path), dtype=np.bool_)
        straighten(cost, barred, path, kept)
        places = [self._costs.place_of(row, column) for row, column in path[kept][1:-1]]
        self._route = (*(Waypoint(x=x, y=y) for x, y in places), self._goal.place)
        self._revision += 1

    def _in_cells(self, x: float, y: float) -> tuple[float, float]:
        assert self._costs is not None
        costs = self._costs
        return x / costs.cell - costs.row0 - 0.5, y / costs.cell - costs.column0 - 0.5

    def _plan(self, stamp_ns: int, x: float, y: float) -> RoutePlan:
        assert self._goal is not None
        length = 0.0
        for waypoint in self._route:
            length += float(np.hypot(waypoint.x - x, waypoint.y - y))
            x, y = waypoint.x, waypoint.y
        return RoutePlan(
            stamp_ns=stamp_ns,
            serial=self._goal.serial,
            goal=self._goal.place,
            revision=self._revision,
            found=True,
            reason="",
            waypoints=self._route,
            length=length,
        )

    def _nothing(self, stamp_ns: int, reason: str) -> RoutePlan:
        assert self._goal is not None
        self._route = ()
        self._revision += 1
        return RoutePlan(
            stamp_ns=stamp_ns,
            serial=self._goal.serial,
            goal=self._goal.place,
            revision=self._revision,
            found=False,
            reason=reason,
            waypoints=(),
            length=float("nan"),
        )


def _holds(cost: Array, cell: tuple[int, int]) -> bool:
    return bool(0 <= cell[0] < cost.shape[0] and 0 <= cell[1] < cost.shape[1])


def _open_around(
    costs: GroundCosts, barred: NDArray[np.bool_], cost: Array, start: tuple[int, int], radius: float
) -> None:
    """Where the robot stands it may walk, however near an obstacle is: only the obstacle itself stays barred there."""
    reach = int(np.ceil(radius / costs.cell))
    rows = slice(max(start[0] - reach, 0), start[0] + reach + 1)
    columns = slice(max(start[1] - reach, 0), start[1] + reach + 1)
    tight = barred[rows, columns] & ~costs.blocked[rows, columns]
    cost[rows, columns][tight] += TIGHT
    barred[rows, columns] &= costs.blocked[rows, columns]
    barred[start] = False


def _cells(parent: NDArray[np.int64], goal: int, columns: int) -> NDArray[np.int64]:
    """Rows and columns (n, 2) from the start to `goal`."""
    path = [goal]
    while parent[path[-1]] >= 0:
        path.append(int(parent[path[-1]]))
    cells = np.array(path[::-1])
    return np.stack([cells // columns, cells % columns], axis=1)
