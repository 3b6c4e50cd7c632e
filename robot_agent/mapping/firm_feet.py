"""Which feet stand firm, and where in the world: once for every time a foot is put down."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.foot_contacts import FootContacts
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

FIRM_TIME_NS = 120_000_000
"""A foot that bears this long has pressed through what is soft and stopped sliding."""


class FirmFeet:
    """Follows the contacts of all legs through batches of readings."""

    def __init__(self, robot: RobotDescription) -> None:
        self._foot_radius = robot.foot_radius
        self._since_ns = np.full(robot.leg_count, -1, dtype=np.int64)
        self._told = np.zeros(robot.leg_count, dtype=np.bool_)

    def step(self, contacts: FootContacts | None, world_from_body: Pose) -> Array:
        """Points of support (k, 3) in world, m, of the feet that have become firm during `contacts`.

        `world_from_body` is the pose at their end.
        """
        if contacts is None:
            return np.zeros((0, 3))
        for stamp_ns, contact in zip(contacts.stamp_ns, contacts.touching, strict=True):
            fresh = contact & (self._since_ns < 0)
            self._since_ns[fresh] = stamp_ns
            self._since_ns[~contact] = -1
            self._told[~contact] = False
        firm = (self._since_ns >= 0) & (contacts.stamp_ns[-1] - self._since_ns >= FIRM_TIME_NS) & ~self._told
        self._told |= firm
        points = contacts.foot_in_body[-1][firm] @ world_from_body.rotation.T + world_from_body.position
        points[:, 2] -= self._foot_radius
        return np.asarray(points)
