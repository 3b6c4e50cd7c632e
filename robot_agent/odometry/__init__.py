"""Stereo-inertial odometry (ICRA'17 III-A)."""
