"""Which feet stand firm, and where in the world: once for every time a foot is put down."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.leg_batch import LegBatch
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

FIRM_TIME_NS = 120_000_000
"""A foot that bears this long has pressed through what is soft and stopped sliding."""


class FirmFeet:
    """Follows the contacts of all legs through batches of readings."""

    def __init__(self, robot: RobotDescription) -> None:
        self._robot = robot
        self._since_ns = np.full(robot.leg_count, -1, dtype=np.int64)
        self._told = np.zeros(robot.leg_count, dtype=np.bool_)

    def step(self, legs: LegBatch, world_from_body: Pose) -> Array:
        """Points of support (k, 3) in world, m, of the feet that have become firm during `legs`.

        `world_from_body` is the pose at the end of the batch.
        """
        for stamp_ns, contact in zip(legs.stamp_ns, legs.foot_contact, strict=True):
            fresh = contact & (self._since_ns < 0)
            self._since_ns[fresh] = stamp_ns
            self._since_ns[~contact] = -1
            self._told[~contact] = False
        if not len(legs.stamp_ns):
            return np.zeros((0, 3))
        firm = (self._since_ns >= 0) & (legs.stamp_ns[-1] - self._since_ns >= FIRM_TIME_NS) & ~self._told
        self._told |= firm
        if not firm.any():
            return np.zeros((0, 3))
        centres = feet_in_body(self._robot, legs.joint_position[-1])[firm]
        points = centres @ world_from_body.rotation.T + world_from_body.position
        points[:, 2] -= self._robot.foot_radius
        return np.asarray(points)
