"""Compiles the search's kernels, so that nothing is compiled inside a running loop."""

import numpy as np

from robot_agent.navigation.route_planner import RoutePlanner
from weaver_shared.messages import NavigationGoal, Waypoint
from weaver_shared.robots import load_robot


class _Plain:
    """A flat map of 64 x 64 cells with a wall."""

    row0 = column0 = -32
    size, cell = 64, 0.02

    def __init__(self) -> None:
        shape = (self.size, self.size)
        self.elevation = np.zeros(shape, dtype=np.float32)
        self.elevation[20:24, 20:24] = 1.0
        self.roughness = np.zeros(shape, dtype=np.float32)
        self.slope = np.zeros(shape, dtype=np.float32)


def warm_up() -> None:
    goal = NavigationGoal(stamp_ns=0, serial=1, active=True, place=Waypoint(x=2.0, y=0.0))
    planner = RoutePlanner(load_robot())
    for stamp_ns in range(2):
        planner.step(goal, _Plain(), 0.0, 0.0, stamp_ns)
