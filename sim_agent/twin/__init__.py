"""A robot that does not exist, in a process of its own: servos, IMU, power and cameras on lines as a real one's."""
