"""Calibration of cameras and IMU: lenses, the eyes' places, and where and how late the IMU is."""

from robot_agent.calibration.warming import warm_up

__all__ = ["warm_up"]
