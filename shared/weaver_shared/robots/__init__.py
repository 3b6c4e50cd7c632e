"""Robot descriptions and what follows from them alone."""

from weaver_shared.robots.catalogue import load_robot, robot_names, robot_of
from weaver_shared.robots.description import RobotDescription

__all__ = ["RobotDescription", "load_robot", "robot_names", "robot_of"]
