"""Gait, stride trajectories, impedance and posture: from body velocity to servo targets (ICRA'17 III-C)."""

from robot_agent.locomotion.postures import Postures
from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from robot_agent.locomotion.walker import Walker
from robot_agent.locomotion.warm_up import warm_up

__all__ = ["Postures", "WalkInput", "WalkOutput", "Walker", "warm_up"]
