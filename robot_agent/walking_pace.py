"""How fast and how dearly the robot walks its missions, for what is still to come of one."""

from __future__ import annotations

from collections import deque
from math import hypot, isfinite, nan

from weaver_shared.config.navigation import PathFollowerConfig
from weaver_shared.robots import RobotDescription

MARK = 0.1
"""m from one mark to the next: more than a walking body sways."""

WINDOW = 3.0
"""m of way, about as much as is known of the ground: what was walked before says little of what is to come."""

JUMP = 1.3
"""Times the robot's largest speed, from which on not the robot has moved but the knowledge of where it is."""

LEAST = 0.5
"""m before anything is said."""


def expected_speed(robot: RobotDescription, gait: str, stride_frequency: float) -> float:
    """m/s straight ahead at this stride frequency (Hz): with the longest strides, and no faster than missions walk.

    A foot on the ground goes back by v * duty / frequency.
    """
    walk, duty = robot.locomotion, robot.gait_table[gait].duty
    frequency = min(stride_frequency, (1.0 - duty) / walk.shortest_swing)
    return min(PathFollowerConfig().forward_speed, walk.largest_speed, walk.largest_stride * frequency / duty)


class WalkingPace:
    """Means over the last metres of missions; turning and slowing down count, pauses do not."""

    def __init__(self, fastest: float) -> None:
        """`fastest` is the largest speed (m/s) that the robot is capable of."""
        self._fastest = JUMP * fastest
        self._marks: deque[tuple[float, float, float]] = deque()  # m, s, J from the mark before
        self._from: tuple[float, float] | None = None
        self._last_ns = 0
        self._seconds = self._energy = 0.0
        self._way = 0.0

    def add(self, stamp_ns: int, xy: tuple[float, float], power: float, *, walking: bool) -> None:
        """One control tick at world `xy` (m), at `power` W of the whole supply; `walking` along a mission."""
        if not (walking and isfinite(xy[0]) and isfinite(xy[1])):
            self._from = None
            return
        if self._from is None:
            self._from, self._last_ns, self._seconds, self._energy = xy, stamp_ns, 0.0, 0.0
            return
        dt = (stamp_ns - self._last_ns) * 1e-9
        self._last_ns = stamp_ns
        self._seconds += dt
        self._energy += power * dt
        way = hypot(xy[0] - self._from[0], xy[1] - self._from[1])
        if way >= MARK:
            if way <= self._fastest * self._seconds:
                self._marks.append((way, self._seconds, self._energy))
                self._way += way
            self._from, self._seconds, self._energy = xy, 0.0, 0.0
            while self._way - self._marks[0][0] >= WINDOW:
                self._way -= self._marks.popleft()[0]

    @property
    def measured_over(self) -> float:
        """m of way that the means are taken over; 0 as long as it is too little for them."""
        return self._way if self._way >= LEAST else 0.0

    @property
    def speed(self) -> float:
        """m/s along the way; NaN unknown."""
        return self._way / sum(mark[1] for mark in self._marks) if self.measured_over else nan

    @property
    def energy_per_metre(self) -> float:
        """J/m of the whole supply; NaN unknown."""
        return sum(mark[2] for mark in self._marks) / self._way if self.measured_over else nan
