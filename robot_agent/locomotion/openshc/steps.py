"""Names of OpenSHC's walk, step, leg and robot states, with its numbers (facts 3.1)."""

STARTING, MOVING, STOPPING, STOPPED = range(4)
SWING, STANCE, FORCE_STANCE, FORCE_STOP = range(4)
WALKING, MANUAL, WALKING_TO_MANUAL, MANUAL_TO_WALKING = 0, 1, -1, -2
UNKNOWN, PACKED, READY, RUNNING = -1, 0, 1, 2
