"""The robot: from pictures, inertia and joints to servo targets, one folder a stage."""
