"""Whether a mission gets on: a robot that is asked to walk and stays where it is, is stuck."""

from __future__ import annotations

from math import hypot, inf

from weaver_shared.config.command import CommandLimits
from weaver_shared.transforms import Pose, wrap_angle

PLACE = 0.15
"""m from where it was seen last: less is no way, for a robot that sways while it steps."""
HEADING = 0.35
"""rad likewise."""


class Headway:
    """Remembers where the robot last was farther away than swaying takes it."""

    def __init__(self, limits: CommandLimits | None = None) -> None:
        self._patience = (limits or CommandLimits()).stuck_seconds
        self.rest()

    def rest(self) -> None:
        """Nothing is asked of the robot: time begins anew when it is."""
        self._x, self._y, self._yaw, self._since_ns = inf, inf, 0.0, 0

    def stuck(self, world_from_body: Pose, stamp_ns: int) -> bool:
        """Take where a walking robot is now; whether it has been there for too long."""
        x, y, yaw = float(world_from_body.position[0]), float(world_from_body.position[1]), world_from_body.yaw
        if not (hypot(x - self._x, y - self._y) < PLACE and abs(wrap_angle(yaw - self._yaw)) < HEADING):
            self._x, self._y, self._yaw, self._since_ns = x, y, yaw, stamp_ns
        return stamp_ns - self._since_ns > self._patience * 1e9
