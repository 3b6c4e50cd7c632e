"""From goals and waypoints to a body velocity (ICRA'17 III-B), with ways found over the map where asked for."""

from robot_agent.navigation.keep_out import Area, AreaFence
from robot_agent.navigation.path_follower import FollowerOutput, PathFollower
from robot_agent.navigation.route_follower import RouteFollower, RouteTick
from robot_agent.navigation.route_planner import RoutePlanner
from robot_agent.navigation.warm_up import warm_up

__all__ = [
    "Area",
    "AreaFence",
    "FollowerOutput",
    "PathFollower",
    "RouteFollower",
    "RoutePlanner",
    "RouteTick",
    "warm_up",
]
