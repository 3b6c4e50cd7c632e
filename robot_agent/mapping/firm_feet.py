"""Which feet stand firm, and where in the world: all of them, and each once for every time it is put down."""

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
        self._standing = np.full((robot.leg_count, 3), np.nan)

    def step(self, contacts: FootContacts | None, world_from_body: Pose) -> Array:
        """Points of support (k, 3) in world, m, of the feet that have become firm during `contacts`.

        `world_from_body` is the pose at their end.
        """
        if contacts is None:
            self._standing = np.full_like(self._standing, np.nan)
            return np.zeros((0, 3))
        for stamp_ns, contact in zip(contacts.stamp_ns, contacts.touching, strict=True):
            fresh = contact & (self._since_ns < 0)
            self._since_ns[fresh] = stamp_ns
            self._since_ns[~contact] = -1
            self._told[~contact] = False
        firm = (self._since_ns >= 0) & (contacts.stamp_ns[-1] - self._since_ns >= FIRM_TIME_NS)
        points = contacts.foot_in_body[-1] @ world_from_body.rotation.T + world_from_body.position
        points[:, 2] -= self._foot_radius
        self._standing = np.where(firm[:, None], points, np.nan)
        new = firm & ~self._told
        self._told |= firm
        return np.asarray(points[new])

    @property
    def standing(self) -> Array:
        """Points of support (legs, 3) in world, m, as of the last step; NaN of feet that do not stand firm."""
        return self._standing
