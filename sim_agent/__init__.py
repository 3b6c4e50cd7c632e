"""The simulated robot: worlds, physics, servos, sensors and pictures."""
