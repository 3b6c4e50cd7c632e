"""Leg kinematics at control rate: frames, Jacobian, foot forces, inverse kinematics and joint speed limits."""

from robot_agent.kinematics.chain import all_leg_frames, foot_jacobian, leg_frames, solve_symmetric
from robot_agent.kinematics.foot_force import foot_force, link_gravity_torque, link_inertia_torque
from robot_agent.kinematics.inverse import solve_leg, solve_legs
from robot_agent.kinematics.joint_speed import limit_joint_speed
from robot_agent.kinematics.leg_model import LegModel

__all__ = [
    "LegModel",
    "all_leg_frames",
    "foot_force",
    "foot_jacobian",
    "leg_frames",
    "limit_joint_speed",
    "link_gravity_torque",
    "link_inertia_torque",
    "solve_leg",
    "solve_legs",
    "solve_symmetric",
]
