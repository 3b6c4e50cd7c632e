"""The same robot in its other posture: another stance, clearance and range of the joints, but the same machine."""

from __future__ import annotations

from typing import Any

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots.catalogue import load_robot
from weaver_shared.robots.description import RobotDescription

MACHINE = ("mass", "foot_radius", "body", "servos", "imu", "stereo")
JOINT = ("name", "servo", "theta", "d", "r", "alpha", "lower", "upper", "mass")
LEG = ("name", "hip_in_body", "hip_yaw", "hip_roll", "mirrored")


def counterpart_of(robot: RobotDescription) -> RobotDescription | None:
    """The description of the other posture; None for a robot that has one posture only.

    Raises ConfigurationError, naming the key, where the two do not describe one machine.
    """
    if robot.posture is None:
        return None
    other = load_robot(robot.posture.counterpart)
    where = f"robot {robot.name!r}: posture.counterpart"
    if other.posture is None:
        raise ConfigurationError(f"{where}: {other.name!r} has no posture; valid is one whose counterpart is this")
    if other.posture.name == robot.posture.name:
        raise ConfigurationError(f"{where}: {other.name!r} is in posture {other.posture.name!r} too; valid is another")
    mine, theirs = _machine(robot), _machine(other)
    for key, value in mine.items():
        if theirs.get(key) != value:
            raise ConfigurationError(
                f"{where}: {key} is {value} here and {theirs.get(key)} in {other.name!r}; one machine has one value"
            )
    if len(mine) != len(theirs):
        raise ConfigurationError(f"{where}: {other.name!r} has more legs or joints; one machine has as many in both")
    return other


def _machine(robot: RobotDescription) -> dict[str, Any]:
    """Everything that a change of posture can not change, by key."""
    result = {key: getattr(robot, key) for key in MACHINE}
    for index, joint in enumerate(robot.joints):
        result |= {f"joints.{index}.{key}": getattr(joint, key) for key in JOINT}
    for index, leg in enumerate(robot.legs):
        result |= {f"legs.{index}.{key}": getattr(leg, key) for key in LEG}
    return result
