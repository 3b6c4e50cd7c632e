"""Day one with a robot: what of its wiring, servos, IMU and power is as it has to be, and what to do where not."""

from robot_agent.hardware.doctor.examination import Examination
from robot_agent.hardware.doctor.finding import Finding, Verdict

__all__ = ["Examination", "Finding", "Verdict"]
