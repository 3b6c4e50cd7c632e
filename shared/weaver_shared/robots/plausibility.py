"""What the parts of a description must satisfy together: feet within reach and servos that carry the robot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import ConfigurationError
from weaver_shared.frames import GRAVITY
from weaver_shared.robots.description import RobotDescription
from weaver_shared.robots.reach import foot_jacobians, joints_reaching, leg_length

REACHED = 1e-3
"""Distance between a foot and its stance that counts as reached, of the leg's length."""


def check(robot: RobotDescription) -> None:
    """Raises ConfigurationError that names the key, what was found and what is valid."""
    joints, left = joints_reaching(robot, robot.stance_in_body, robot.standing_search)
    _check_stance(robot, left)
    _check_torque(robot, joints)


def _check_stance(robot: RobotDescription, left: NDArray[np.float64]) -> None:
    leg = int(np.argmax(left))
    if left[leg] <= REACHED * leg_length(robot):
        return
    found = robot.legs[leg].stance_in_body
    apart = float(np.linalg.norm(robot.stance_in_body[leg] - robot.hips_in_body[leg]))
    raise ConfigurationError(
        f"robot {robot.name!r}: legs.{leg}.stance_in_body: leg {robot.legs[leg].name} comes no nearer than "
        f"{left[leg]:.3f} m to ({found[0]:g}, {found[1]:g}) m at clearance {robot.clearance:g} m, "
        f"which is {apart:.3f} m from its hip; the leg is {leg_length(robot):.3f} m "
        "long, and its joints' limits must allow the place too"
    )


def _check_torque(robot: RobotDescription, joints: NDArray[np.float64]) -> None:
    """Standing on every second foot, as in a tripod, no servo may need more than it has."""
    load = robot.mass * GRAVITY / max(robot.leg_count // 2, 2)
    needed = np.abs(foot_jacobians(robot, joints)[:, 2]).max(axis=0) * load
    for joint, torque in zip(robot.joints, needed, strict=True):
        stall = robot.servos[joint.servo].stall_torque
        if torque > stall:
            raise ConfigurationError(
                f"robot {robot.name!r}: servos.{joint.servo}.stall_torque: joint {joint.name} needs {torque:.1f} N m "
                f"when half of the feet carry {robot.mass:g} kg, but the servo has {stall:g} N m; "
                f"give a stronger servo, less mass or a narrower stance"
            )
