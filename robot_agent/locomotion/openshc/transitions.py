"""Movements that take a given time: of joints along a cubic curve, of a tip along two quartic ones (facts 3.14)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.bezier import quartic
from robot_agent.locomotion.openshc.body_pose import BodyPose, smooth_step
from robot_agent.locomotion.openshc.leg import Leg

Array = NDArray[np.float64]

COMPLETE = 100
"""Per cent."""
TIP_TOLERANCE = 0.01


def ticks_of(seconds: float, dt: float) -> int:
    return max(1, int(seconds / dt + 0.5))


class JointMove:
    """All joints of a leg to `target` (n,) at once."""

    def __init__(self, leg: Leg, target: Array, seconds: float, dt: float) -> None:
        self._leg, self._origin, self._target = leg, leg.position.copy(), target
        self._ticks, self._done = ticks_of(seconds, dt), 0

    def tick(self) -> int:
        """Progress in per cent. The joints' rates are left as they were."""
        self._done += 1
        t = self._done / self._ticks
        s = 1.0 - t
        first, last = s**3 + 3.0 * t * s * s, 3.0 * t * t * s + t**3
        self._leg.position = self._origin * first + self._target * last
        if self._done >= self._ticks:
            return COMPLETE
        return max(1, int((self._done - 1) / self._ticks * COMPLETE))


class TipMove:
    """A tip from where it is to `target` (3,), lifted half-way, while the body takes `pose` with a smooth step.

    `tip` (3,) and `direction` (3,) are in body; the caller has the leg follow them.
    """

    def __init__(
        self,
        origin: Array,
        origin_direction: Array,
        target: Array,
        *,
        pose: BodyPose,
        lift: float,
        seconds: float,
        dt: float,
        direction: Array | None = None,
    ) -> None:
        self._origin, self._target, self._pose, self._lift = origin, target, pose, lift
        self._origin_direction, self._target_direction = origin_direction, direction
        self._ticks, self._done = ticks_of(seconds, dt), 0
        self.tip = origin
        self.direction: Array | None = None

    def tick(self, offset: Array | None = None) -> int:
        """Progress in per cent; `offset` (3,) is added to the target."""
        target = self._target if offset is None else self._target + offset
        if self._lift == 0.0 and float(np.linalg.norm(self._origin - self._pose.into(target))) < TIP_TOLERANCE:
            return COMPLETE
        self._done += 1
        share = (self._done - 1) / self._ticks
        pose = BodyPose().blended(smooth_step(share), self._pose)
        self.tip = pose.into(self._along(target))
        self.direction = self._turned(smooth_step(share))
        return COMPLETE if self._done >= self._ticks else int(share * COMPLETE)

    def _along(self, target: Array) -> Array:
        origin, back, up = self._origin, self._origin - target, np.array([0.0, 0.0, self._lift])
        half = self._ticks // 2
        if self._done <= half:
            nodes = [origin, origin, origin + up, target + 0.75 * back + up, target + 0.5 * back + up]
            t = self._done / self._ticks * 2.0
        else:
            nodes = [target + 0.5 * back + up, target + 0.25 * back + up, target + up, target, target]
            t = (self._done - half) / self._ticks * 2.0
        point = np.empty(3)
        quartic(np.array(nodes), t, point)
        return point

    def _turned(self, share: float) -> Array | None:
        if self._target_direction is None:
            return None
        blend = (1.0 - share) * self._origin_direction + share * self._target_direction
        turned: Array = blend / np.linalg.norm(blend)
        return turned
