"""What limits the walking, as bits that kernels set and sentences that people read."""

from functools import cache

JOINT_ANGLE, JOINT_TORQUE, GRAVITY = 1, 2, 4
VELOCITY, PARAMETER = 8, 16
SERVO_SPEED, STRIDE, NO_GROUND, LEFT_BEHIND, SLOW_SERVOS, FOOTHOLD = 32, 64, 128, 256, 512, 1024

SENTENCES = {
    JOINT_ANGLE: "a joint angle is missing",
    JOINT_TORQUE: "a joint torque is missing",
    GRAVITY: "the direction of gravity is missing",
    VELOCITY: "the velocity order is not a number",
    PARAMETER: "a gait parameter is not a number",
    SERVO_SPEED: "a servo is at its largest speed",
    STRIDE: "the stride is at its limit",
    NO_GROUND: "waiting for a foot to find ground",
    LEFT_BEHIND: "a foot is left far behind",
    SLOW_SERVOS: "the gait is slowed to what the servos can follow",
    FOOTHOLD: "a foothold asked for is out of reach",
}


@cache
def sentences(reasons: int) -> tuple[str, ...]:
    """The sentences of the bits set in `reasons`."""
    return tuple(text for bit, text in SENTENCES.items() if reasons & bit)
