"""Joint angles of a robot that sits: belly on the ground, feet on the ground where they will stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.reach import joints_reaching

Array = NDArray[np.float64]

TOLERANCE = 5e-4  # m


def sitting_joints(robot: RobotDescription) -> Array:
    """Joint angles (joints,) in rad that put every foot centre where it is when sitting.

    Raises ConfigurationError when the legs can not reach.
    """
    joints, left = joints_reaching(robot, robot.sitting_in_body, robot.sitting_search)
    if float(left.max()) > TOLERANCE:
        raise ConfigurationError(
            f"robot {robot.name!r} can not sit: leg {robot.leg_names[int(np.argmax(left))]} comes no nearer than "
            f"{left.max():.3f} m to the ground under its stance with the belly {robot.sitting_gap:g} m above it; "
            "give a larger sitting_gap, wider limits, or sitting angles of the joints nearer to a solution"
        )
    return joints.ravel()
