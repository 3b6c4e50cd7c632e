"""The robot as solids: links, URDF and the pose it starts in."""

from sim_agent.model.links import Link, leg_links, link_poses
from sim_agent.model.sitting import sitting_joints
from sim_agent.model.urdf import robot_urdf

__all__ = ["Link", "leg_links", "link_poses", "robot_urdf", "sitting_joints"]
