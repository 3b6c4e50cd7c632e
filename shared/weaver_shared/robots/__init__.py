"""Robot descriptions and what follows from them alone."""

from weaver_shared.robots.description import RobotDescription, load_robot, robot_names

__all__ = ["RobotDescription", "load_robot", "robot_names"]
