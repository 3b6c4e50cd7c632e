"""A legged robot's URDF as a description of ours."""

from weaver_shared.robots.urdf.robot import ImportedRobot, JointMeaning, robot_of_urdf

__all__ = ["ImportedRobot", "JointMeaning", "robot_of_urdf"]
