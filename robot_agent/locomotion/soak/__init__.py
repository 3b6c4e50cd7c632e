"""Random lives of random robots: whatever the walker is given, its answers are finite and keep the joints' limits."""

from robot_agent.locomotion.soak.life import Violation, soak

__all__ = ["Violation", "soak"]
