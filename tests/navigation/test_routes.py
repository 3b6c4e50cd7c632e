"""Ways are found around what can not be stepped over, shortest first, kept while good, and refused when none is."""

import heapq
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.navigation import RouteFollower, RoutePlanner
from robot_agent.navigation.clearance import add_clearance
from robot_agent.navigation.grid_search import DIAGONAL, cheapest_path, line_cost, straighten
from robot_agent.navigation.ground_costs import GroundCosts
from weaver_shared.config.navigation import RouteConfig
from weaver_shared.messages import NavigationGoal, RoutePlan, Waypoint
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

ROBOT = load_robot("weaver")
CONFIG = RouteConfig()
RADIUS = 0.41 + ROBOT.foot_radius


class Map:
    """A rolling map of level ground around `x0`, `y0`; `known` False begins it empty."""

    def __init__(self, size=352, cell=0.02, centre=(0.0, 0.0), *, known=True):
        self.size, self.cell = size, cell
        self.row0 = int(centre[0] / cell) - size // 2
        self.column0 = int(centre[1] / cell) - size // 2
        self.elevation = np.full((size, size), 0.0 if known else np.nan, dtype=np.float32)
        self.roughness = np.zeros((size, size), dtype=np.float32)
        self.slope = np.zeros((size, size), dtype=np.float32)

    def block(self, x, y, height=0.5):
        """Raise the ground between x[0] and x[1], y[0] and y[1], world m."""
        rows = np.arange(int(np.floor(x[0] / self.cell)), int(np.ceil(x[1] / self.cell))) % self.size
        columns = np.arange(int(np.floor(y[0] / self.cell)), int(np.ceil(y[1] / self.cell))) % self.size
        self.elevation[np.ix_(rows, columns)] = height
        return self


def goal(x, y, serial=1):
    return NavigationGoal(stamp_ns=0, serial=serial, active=True, place=Waypoint(x=x, y=y))


def points(plan, start=(0.0, 0.0)):
    """Points 1 cm apart along a route, (n, 2)."""
    corners = np.array([start, *((w.x, w.y) for w in plan.waypoints)])
    parts = []
    for a, b in pairwise(corners):
        parts.append(a + np.linspace(0.0, 1.0, max(int(np.linalg.norm(b - a) * 100), 2))[:, None] * (b - a))
    return np.concatenate(parts)


def distance_to_box(path, x, y):
    dx = np.maximum(np.maximum(x[0] - path[:, 0], path[:, 0] - x[1]), 0.0)
    dy = np.maximum(np.maximum(y[0] - path[:, 1], path[:, 1] - y[1]), 0.0)
    return float(np.hypot(dx, dy).min())


def test_over_open_ground_the_way_is_straight():
    plan = RoutePlanner(ROBOT).step(goal(2.5, 1.0), Map(), 0.0, 0.0, 0)
    assert plan.found
    assert plan.waypoints == (Waypoint(x=2.5, y=1.0),)
    assert plan.length == pytest.approx(np.hypot(2.5, 1.0))


def test_a_wall_is_gone_around_with_room_for_the_feet():
    ground = Map().block((1.2, 1.4), (-0.8, 2.0))
    plan = RoutePlanner(ROBOT).step(goal(2.6, 0.0), ground, 0.0, 0.0, 0)
    assert plan.found
    assert plan.waypoints[-1] == Waypoint(x=2.6, y=0.0)
    assert distance_to_box(points(plan), (1.2, 1.4), (-0.8, 2.0)) >= RADIUS - 0.02
    assert min(w.y for w in plan.waypoints) < -1.0  # round the near end, not the far one
    assert plan.length < 4.6  # 3.6 m along the corners' circles, and room for comfort


def test_what_the_legs_can_step_over_is_no_obstacle_but_costs():
    low = Map().block((1.2, 1.4), (-1.5, 1.5), height=0.15)
    plan = RoutePlanner(ROBOT).step(goal(2.6, 0.0), low, 0.0, 0.0, 0)
    assert plan.found
    assert plan.length < 2.8
    narrow = Map().block((1.2, 1.4), (-0.2, 0.2), height=0.15)
    plan = RoutePlanner(ROBOT).step(goal(2.6, 0.0), narrow, 0.0, 0.0, 0)
    assert abs(points(plan)[:, 1]).max() > 0.15  # a small one is avoided


def test_rough_ground_is_avoided_where_the_detour_is_small():
    ground = Map()
    rows, columns = np.arange(40, 80) % ground.size, np.arange(-20, 60) % ground.size
    ground.roughness[np.ix_(rows, columns)] = 1.0
    plan = RoutePlanner(ROBOT).step(goal(2.6, 0.0), ground, 0.0, 0.0, 0)
    assert points(plan)[:, 1].min() < -0.3


def test_a_closed_pen_has_no_way_and_says_so():
    ground = Map()
    for x, y in (((1.2, 1.4), (-1.4, 1.4)), ((-1.4, -1.2), (-1.4, 1.4)), ((-1.4, 1.4), (1.2, 1.4)),
                 ((-1.4, 1.4), (-1.4, -1.2))):  # fmt: skip
        ground.block(x, y)
    plan = RoutePlanner(ROBOT).step(goal(2.6, 0.0), ground, 0.0, 0.0, 0)
    assert not plan.found
    assert plan.waypoints == ()
    assert "close every way" in plan.reason


def test_a_goal_inside_an_obstacle_is_refused_with_the_reason():
    plan = RoutePlanner(ROBOT).step(goal(2.0, 0.0), Map().block((1.8, 2.2), (-0.2, 0.2)), 0.0, 0.0, 0)
    assert not plan.found
    assert "nearer than" in plan.reason


def test_a_robot_beside_a_wall_can_leave_it():
    ground = Map().block((0.30, 0.5), (-1.0, 1.0))
    plan = RoutePlanner(ROBOT).step(goal(-1.5, 0.0), ground, 0.0, 0.0, 0)
    assert plan.found


def test_an_obstacle_seen_later_changes_the_way_and_one_forgotten_by_the_map_does_not():
    planner, target = RoutePlanner(ROBOT), goal(2.6, 0.0)
    unknown = Map(known=False)
    first = planner.step(target, unknown, 0.0, 0.0, 0)
    assert first.waypoints == (target.place,)
    seen = Map(known=False).block((-1.0, 1.2), (-2.0, 2.0), height=0.0).block((1.2, 1.4), (-0.8, 2.0))
    second = planner.step(target, seen, 0.1, 0.0, 1)
    assert second.revision > first.revision
    assert len(second.waypoints) > 1
    third = planner.step(target, unknown, 0.15, -0.05, 2)  # the map has rolled on
    assert len(third.waypoints) > 1


def test_a_route_is_kept_while_it_is_hardly_worse_than_the_best():
    planner, target = RoutePlanner(ROBOT), goal(2.6, 0.0)
    ground = Map().block((1.2, 1.4), (-0.8, 2.0))
    revisions = {planner.step(target, ground, 0.02 * k, -0.04 * k, k).revision for k in range(10)}
    assert len(revisions) == 1


FORBIDDEN = tuple(Waypoint(x=x, y=y) for x, y in ((1.2, -0.8), (1.4, -0.8), (1.4, 2.0), (1.2, 2.0)))


def test_a_forbidden_area_is_gone_around_like_a_wall():
    plan = RoutePlanner(ROBOT).step(goal(2.6, 0.0), Map(), 0.0, 0.0, 0, [FORBIDDEN])
    assert plan.found
    assert distance_to_box(points(plan), (1.2, 1.4), (-0.8, 2.0)) >= RADIUS - 0.02
    assert plan.length < 4.6


def test_an_area_forbidden_under_way_changes_the_route_and_one_taken_back_does_too():
    planner, target = RoutePlanner(ROBOT), goal(2.6, 0.0)
    assert planner.step(target, Map(), 0.0, 0.0, 0).waypoints == (target.place,)
    assert len(planner.step(target, Map(), 0.1, 0.0, 1, [FORBIDDEN]).waypoints) > 1
    assert planner.step(target, Map(), 0.1, 0.0, 2, []).waypoints == (target.place,)


def test_a_goal_in_a_forbidden_area_and_a_closed_way_are_told():
    plan = RoutePlanner(ROBOT).step(goal(1.3, 0.5), Map(), 0.0, 0.0, 0, [FORBIDDEN])
    assert (plan.found, "to forbidden area 1" in plan.reason) == (False, True)
    across = tuple(Waypoint(x=x, y=y) for x, y in ((1.2, -9.0), (1.4, -9.0), (1.4, 9.0), (1.2, 9.0)))
    plan = RoutePlanner(ROBOT).step(goal(2.6, 0.0), Map(), 0.0, 0.0, 0, [across])
    assert plan.reason == "obstacles and forbidden areas close every way to the goal"


def test_from_within_an_area_the_way_leads_out_by_the_nearest_edge():
    wide = tuple(Waypoint(x=x, y=y) for x, y in ((-0.3, -2.0), (1.5, -2.0), (1.5, 2.0), (-0.3, 2.0)))
    plan = RoutePlanner(ROBOT).step(goal(3.0, 0.0), Map(), 0.0, 0.0, 0, [wide])
    assert plan.found
    path = points(plan)
    assert path[:, 0].min() < -0.3  # back over the near edge, and then around
    inside = (path[:, 0] > -0.25) & (path[:, 0] < 1.5) & (np.abs(path[:, 1]) < 2.0)
    assert not inside[np.argmin(path[:, 0]) :].any()


def dijkstra(cost, barred, start, end):
    rows, columns = cost.shape
    best, queue = {start: 0.0}, [(0.0, start)]
    while queue:
        total, (r, c) = heapq.heappop(queue)
        if (r, c) == end:
            return total
        if total > best[(r, c)]:
            continue
        for dr, dc in ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)):
            i, j = r + dr, c + dc
            if not (0 <= i < rows and 0 <= j < columns) or barred[i, j]:
                continue
            if dr and dc and (barred[i, c] or barred[r, j]):
                continue
            further = total + 0.5 * (DIAGONAL if dr and dc else 1.0) * (cost[r, c] + cost[i, j])
            if further < best.get((i, j), np.inf) - 1e-12:
                best[(i, j)] = further
                heapq.heappush(queue, (further, (i, j)))
    return np.inf


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.4))
def test_the_way_found_is_the_cheapest_there_is(seed, share):
    generator = np.random.default_rng(seed)
    shape = tuple(generator.integers(2, 16, 2))
    cost = 1.0 + 4.0 * generator.random(shape)
    barred = generator.random(shape) < share
    start, end = (0, 0), (int(shape[0]) - 1, int(shape[1]) - 1)
    barred[start] = barred[end] = False
    parent = np.empty(cost.size, dtype=np.int64)
    found = cheapest_path(cost, barred, 0, cost.size - 1, parent)
    assert found == pytest.approx(dijkstra(cost, barred, start, end)) or (
        found == np.inf and dijkstra(cost, barred, start, end) == np.inf
    )


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_a_straightened_way_is_free_and_hardly_dearer(seed):
    generator = np.random.default_rng(seed)
    cost, barred = 1.0 + generator.random((24, 24)), generator.random((24, 24)) < 0.2
    barred[0, 0] = barred[23, 23] = False
    parent = np.empty(cost.size, dtype=np.int64)
    if not np.isfinite(cheapest_path(cost, barred, 0, cost.size - 1, parent)):
        return
    path = [cost.size - 1]
    while parent[path[-1]] >= 0:
        path.append(int(parent[path[-1]]))
    cells = np.stack(np.divmod(np.array(path[::-1]), 24), axis=1)
    kept = np.zeros(len(cells), dtype=bool)
    straighten(cost, barred, cells, kept)
    assert kept[0]
    assert kept[-1]
    corners = cells[kept].astype(float)

    def along(way):
        return sum(line_cost(cost, barred, *a, *b) for a, b in pairwise(way))

    assert along(corners) <= 1.02 * along(cells.astype(float)) + 1e-6
    assert np.isfinite(along(corners))


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_clearance_bars_exactly_the_circle_about_every_obstacle(seed):
    generator = np.random.default_rng(seed)
    blocked = generator.random((20, 25)) < 0.03
    cost, barred = np.ones(blocked.shape), np.zeros_like(blocked)
    add_clearance(blocked, 0.08, 0.3, 0.2, 4.0, cost, barred)
    rows, columns = np.nonzero(blocked)
    grid = np.stack(np.meshgrid(np.arange(20), np.arange(25), indexing="ij"), axis=-1)
    if rows.size == 0:
        assert not barred.any()
        return
    nearest = np.hypot(grid[..., :1] - rows, grid[..., 1:] - columns).min(axis=-1) * 0.08
    np.testing.assert_array_equal(barred, nearest < 0.3)
    assert (cost[nearest >= 0.5] == 1.0).all()
    assert (cost[nearest < 0.3] == 5.0).all()


def test_a_map_rolled_to_any_place_gives_the_same_costs():
    seen = []
    for centre in ((0.0, 0.0), (1.3, -0.7), (-1.0, 1.6)):
        costs = GroundCosts(CONFIG, np.array([[0.0, 0.0], [1.0, 0.0]]))
        costs.learn(Map(centre=centre).block((0.5, 0.8), (0.1, 0.5)))
        row, column = costs.cell_of(0.0, 0.0)
        part = (slice(row - 3, row + 20), slice(column - 10, column + 12))
        assert costs.known[part].all()
        seen.append((costs.cost[part], costs.blocked[part]))
        assert costs.blocked[costs.cell_of(0.54, 0.3)]
        assert not costs.blocked[costs.cell_of(0.0, 0.0)]
    for cost, blocked in seen[1:]:
        np.testing.assert_array_equal(cost, seen[0][0])
        np.testing.assert_array_equal(blocked, seen[0][1])


def route(revision=1, *, found=True, stamp_ns=0, places=((1.0, 0.5), (2.0, 0.0))):
    waypoints = tuple(Waypoint(x=x, y=y) for x, y in places) if found else ()
    return RoutePlan(
        stamp_ns=stamp_ns, serial=1, goal=Waypoint(x=2.0, y=0.0), revision=revision, found=found,
        reason="" if found else "obstacles close every way to the goal", waypoints=waypoints, length=2.2,
    )  # fmt: skip


GOALS = (Waypoint(x=2.0, y=0.0),)
HERE = Pose.of((0.0, 0.0, 0.16))


def test_without_a_route_the_robot_waits_and_asks_for_one():
    tick = RouteFollower().step(HERE, GOALS, 1, None, 0)
    assert not tick.follower.velocity.any()
    assert tick.waiting == "looking for a way"
    assert tick.goal.place == GOALS[0]
    assert RouteFollower().step(HERE, GOALS, 2, route(), 0).waiting == "looking for a way"  # another mission's


def test_a_route_is_walked_to_its_end_in_any_number_of_revisions():
    follower, x, y, yaw = RouteFollower(), 0.0, 0.0, 0.0
    for tick in range(4000):
        stamp_ns = tick * 10_000_000
        places = ((1.0, 0.5), (2.0, 0.0)) if tick < 300 else ((2.0, 0.0),)
        newest = route(1 + tick // 150, stamp_ns=stamp_ns, places=places)
        done = follower.step(
            Pose.of((x, y, 0.16), (np.cos(yaw / 2), 0, 0, np.sin(yaw / 2))), GOALS, 1, newest, stamp_ns
        )
        vx, vy, turn = done.follower.velocity
        x += 0.01 * (vx * np.cos(yaw) - vy * np.sin(yaw))
        y += 0.01 * (vx * np.sin(yaw) + vy * np.cos(yaw))
        yaw += 0.01 * turn
        if done.follower.done:
            break
    assert done.follower.done
    assert done.follower.index == 1
    assert np.hypot(x - 2.0, y) < 0.11


def test_no_way_for_longer_than_patience_is_hopeless_and_an_old_route_is_not_followed():
    follower = RouteFollower()
    for second in range(6):
        tick = follower.step(HERE, GOALS, 1, route(found=False, stamp_ns=second * 10**9), second * 10**9)
        assert not tick.follower.velocity.any()
        assert "close every way" in tick.waiting
        assert tick.hopeless == (second > CONFIG.patience)
    old = follower.step(HERE, GOALS, 1, route(stamp_ns=0), 10 * 10**9)
    assert "no way is known" in old.waiting
    assert not old.hopeless


def test_goals_are_visited_one_after_the_other():
    follower, goals = RouteFollower(), (Waypoint(x=0.2, y=0.0), Waypoint(x=2.0, y=0.0))
    tick = follower.step(HERE, goals, 1, route(), 0)
    assert tick.goal.place == goals[1]  # the first is near enough
    assert tick.follower.index == 1
    assert replace(route(), serial=1).goal == tick.goal.place


def test_a_route_into_a_forbidden_area_is_not_followed_and_one_around_it_is():
    follower, areas = RouteFollower(half_width=ROBOT.half_width), (FORBIDDEN,)
    assert follower.step(HERE, GOALS, 1, route(), 0).follower.velocity.any()
    tick = follower.step(HERE, GOALS, 1, route(), 1, areas)  # forbidden under way
    assert not tick.follower.velocity.any()
    assert tick.waiting == "no way: the one that was found leads into forbidden area 1"
    around = route(2, places=((1.0, -1.4), (1.6, -1.4), (2.0, 0.0)))
    assert follower.step(HERE, GOALS, 1, around, 2, areas).follower.velocity.any()
    assert follower.step(HERE, GOALS, 1, route(2), 3).follower.velocity.any()  # taken back
