"""Lookahead steering along straight segments (ICRA'17 III-B, eqs. 1-5).

Signs. The cross-track error e is positive where the robot is left of the line from p_k to p_k+1; yaw and turn are
positive to the left. With these axes two of the printed equations run away from the line, and one is unbounded:

- (2) prints V_y = V_y,max e / |alpha_e| inside |alpha_e| < alpha_e0. It grows without bound as the heading becomes
  right, and pushes a robot on the left farther left. Used is V_y = -V_y,max (e / R) (1 - |alpha_e| / alpha_e0), with
  |e| / R at most 1: the same conditions, bounded, towards the line.
- (4) prints turn = -K_rot (alpha_d - yaw), which turns away from the wanted course. Used is +K_rot.
- (5) alpha_d = alpha_k + arctan(-e / d) is right as printed.

Where |e| exceeds R the lookahead d = sqrt(R^2 - e^2) is taken as zero: the robot heads straight for the line. V_x of
(1) is further scaled by the cosine of the course error and fades to nothing as that error grows, so that a robot facing
elsewhere turns before it walks and stays near its path where that is narrow.
Within R of the last waypoint, and where a waypoint was passed outside its circle, the robot walks straight at the
point, in whatever direction of its body that is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, hypot, isfinite, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.navigation import PathFollowerConfig
from weaver_shared.messages import Waypoint
from weaver_shared.transforms import Pose, wrap_angle

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class FollowerOutput:
    velocity: Array  # (3,) vx, vy m/s and turn rad/s, in body
    index: int  # of the waypoint being approached; the number of waypoints when done
    cross_track_error: float  # m, positive to the left of the path
    distance_left: float  # m, along the waypoints still to come
    done: bool
    lookahead_in_world: Array  # (2,) point on the path steered at; NaN when done


class PathFollower:
    """Stateless but for its settings: the caller keeps the index of the waypoint being approached."""

    def __init__(self, config: PathFollowerConfig | None = None) -> None:
        self._config = config or PathFollowerConfig()

    def step(self, world_from_body: Pose, waypoints: Sequence[Waypoint], index: int) -> FollowerOutput:
        """Velocity towards waypoint `index`, on the line from the one before it, or from here where there is none.

        A pose that is not finite asks for no motion and changes nothing.
        """
        x, y, yaw = float(world_from_body.position[0]), float(world_from_body.position[1]), world_from_body.yaw
        if not (isfinite(x) and isfinite(y) and isfinite(yaw)):
            return _still(index, done=False)
        index = self._next_index((x, y), waypoints, max(index, 0))
        if index >= len(waypoints):
            return _still(len(waypoints), done=True)
        segment = _Segment.of(waypoints, index, (x, y))
        error, ahead = segment.relative(x, y)
        last = index == len(waypoints) - 1
        near = hypot(segment.end[0] - x, segment.end[1] - y) < self._config.acceptance_radius
        if ahead <= 0.0 or (last and near):
            velocity, lookahead = self._straight_at(segment.end, x, y, yaw, turn=not (last and near))
        else:
            velocity, lookahead = self._along(segment, error, ahead, yaw)
        return FollowerOutput(
            velocity=velocity,
            index=index,
            cross_track_error=error,
            distance_left=_distance_left((x, y), waypoints, index),
            done=False,
            lookahead_in_world=lookahead,
        )

    def _next_index(self, here: tuple[float, float], waypoints: Sequence[Waypoint], index: int) -> int:
        """Skip waypoints inside the circle of acceptance; the last one has to be reached."""
        while index < len(waypoints):
            distance = hypot(waypoints[index].x - here[0], waypoints[index].y - here[1])
            last = index == len(waypoints) - 1
            if distance >= (self._config.goal_radius if last else self._config.acceptance_radius):
                break
            index += 1
        return index

    def _along(self, segment: _Segment, error: float, ahead: float, yaw: float) -> tuple[Array, Array]:
        """Equations 1 to 5 on one segment, `ahead` m before its end."""
        config = self._config
        radius = config.acceptance_radius
        lookahead = sqrt(max(radius**2 - error**2, 0.0))
        course = segment.course - atan2(error, lookahead) if error else segment.course
        off_course = wrap_angle(course - yaw)
        forward = config.forward_speed * ahead / hypot(ahead, lookahead) * self._share_ahead(off_course)
        heading_error = abs(wrap_angle(segment.course - yaw))
        side = 0.0
        if heading_error < config.side_angle:
            share = min(max(error / radius, -1.0), 1.0)
            side = -config.side_speed * share * (1.0 - heading_error / config.side_angle)
        point = segment.point(ahead - min(lookahead, ahead))
        return np.array([forward, side, self._turn(off_course)]), point

    def _straight_at(
        self, goal: tuple[float, float], x: float, y: float, yaw: float, *, turn: bool
    ) -> tuple[Array, Array]:
        """Walk at a point in whatever direction of the body it is; turn to it as well if it is passed or far."""
        config = self._config
        distance = hypot(goal[0] - x, goal[1] - y)
        bearing = wrap_angle(atan2(goal[1] - y, goal[0] - x) - yaw)
        # The speed in a direction is that of the ellipse of forward and side speed.
        largest = 1.0 / hypot(cos(bearing) / config.forward_speed, sin(bearing) / config.side_speed)
        speed = min(largest, max(config.goal_gain * distance, config.slowest))
        rate = self._turn(bearing) if turn else 0.0
        return np.array([speed * cos(bearing), speed * sin(bearing), rate]), np.array(goal)

    def _share_ahead(self, off_course: float) -> float:
        """Of the forward speed, for a heading so far (rad) off the course."""
        whole, none = self._config.turn_first
        fade = min(max((none - abs(off_course)) / (none - whole), 0.0), 1.0)
        return cos(off_course) * fade

    def _turn(self, angle: float) -> float:
        rate = self._config.turn_gain * angle
        return min(max(rate, -self._config.turn_rate), self._config.turn_rate)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Segment:
    """The line to a waypoint: its end in world (m) and its direction alpha_k (rad)."""

    end: tuple[float, float]
    course: float

    @staticmethod
    def of(waypoints: Sequence[Waypoint], index: int, here: tuple[float, float]) -> _Segment:
        end = (waypoints[index].x, waypoints[index].y)
        begin = (waypoints[index - 1].x, waypoints[index - 1].y) if index > 0 else here
        if hypot(end[0] - begin[0], end[1] - begin[1]) < 1e-6:
            begin = here
        return _Segment(end=end, course=atan2(end[1] - begin[1], end[0] - begin[0]))

    def relative(self, x: float, y: float) -> tuple[float, float]:
        """Cross-track error, positive to the left, and along-track distance left to the end, both m."""
        dx, dy = x - self.end[0], y - self.end[1]
        c, s = cos(self.course), sin(self.course)
        return -s * dx + c * dy, -(c * dx + s * dy)

    def point(self, before_end: float) -> Array:
        """Point on the line, (2,), so many m before its end."""
        return np.array([self.end[0] - before_end * cos(self.course), self.end[1] - before_end * sin(self.course)])


def _distance_left(here: tuple[float, float], waypoints: Sequence[Waypoint], index: int) -> float:
    total = 0.0
    for waypoint in waypoints[index:]:
        total += hypot(waypoint.x - here[0], waypoint.y - here[1])
        here = (waypoint.x, waypoint.y)
    return total


def _still(index: int, *, done: bool) -> FollowerOutput:
    return FollowerOutput(
        velocity=np.zeros(3),
        index=index,
        cross_track_error=0.0,
        distance_left=0.0,
        done=done,
        lookahead_in_world=np.full(2, np.nan),
    )
