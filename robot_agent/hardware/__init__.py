"""Real servos, IMU, cameras and power."""
