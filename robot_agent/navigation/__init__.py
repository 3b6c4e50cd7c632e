"""From waypoints to a body velocity (ICRA'17 III-B)."""

from robot_agent.navigation.path_follower import FollowerOutput, PathFollower

__all__ = ["FollowerOutput", "PathFollower"]
