"""Calibration of cameras and IMU."""
