"""How a robot stands at one instant, as the scene draws it: worked out once, however many pages watch."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from weaver_shared.messages import RobotState
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Single = NDArray[np.float32]

SHORTEST_LINK = 0.005
MOST_KEPT = 64
"""Robots whose newest posture is kept."""


class Posture:
    """Each part is worked out when it is first asked for."""

    def __init__(self, robot: RobotDescription, state: RobotState) -> None:
        self.state = state
        self._robot = robot

    @cached_property
    def frames(self) -> Array:
        """Along every leg in body, (legs, joints + 1, 4, 4)."""
        return joint_frames_in_body(self._robot, self.state.joint_position)

    @cached_property
    def links(self) -> tuple[Single, Single]:
        """Middles (n, 3) and attitudes (n, 4) of the visible links of all legs, in body, z along the link."""
        middles, wxyzs, _ = segments(self.frames, visible_links(self.frames))
        return middles.astype(np.float32), wxyzs.astype(np.float32)

    @cached_property
    def joints(self) -> Single:
        """Joints of all legs in body, (n, 3)."""
        return self.frames[:, :-1, :3, 3].reshape(-1, 3).astype(np.float32)

    @cached_property
    def feet(self) -> Single:
        """In body, (legs, 3)."""
        return self.frames[:, -1, :3, 3].astype(np.float32)

    @cached_property
    def world_from_body(self) -> Pose:
        return Pose.of(self.state.position_in_world, self.state.wxyz)

    @cached_property
    def feet_in_world(self) -> Array:
        """As the robot tells them, (legs, 3)."""
        return np.asarray(self.world_from_body.transform(self.state.foot_in_body))

    @cached_property
    def support(self) -> Array:
        """Corners of the support polygon in world, the first repeated, (n + 1, 3); empty below three feet."""
        return closed_hull(self.feet_in_world[self.state.foot_contact])

    @cached_property
    def mass(self) -> Array:
        """Centre of mass in world, (3,)."""
        return np.asarray(self.world_from_body.transform(centre_of_mass(self._robot, self.frames)[None])[0])


class Postures:
    """The newest posture of each robot."""

    def __init__(self) -> None:
        self._newest: dict[int, Posture] = {}

    def of(self, robot: RobotDescription, state: RobotState) -> Posture:
        posture = self._newest.get(id(robot))
        if posture is None or posture.state is not state:
            if len(self._newest) >= MOST_KEPT:
                self._newest.clear()
            posture = self._newest[id(robot)] = Posture(robot, state)
        return posture


def visible_links(frames: Array) -> NDArray[np.int_]:
    """Chain positions at which a leg's visible links begin, the next one being their end: frames that coincide are one
    joint, (n,)."""
    points = frames[0, :, :3, 3]
    return np.flatnonzero(np.linalg.norm(np.diff(points, axis=0), axis=1) > SHORTEST_LINK)


def segments(frames: Array, first: NDArray[np.int_]) -> tuple[Array, Array, Array]:
    """Middles (n, 3), attitudes (n, 4) with z along the link, and lengths (n,) of the links of all legs, in body."""
    points = frames[..., :3, 3]
    begin, end = points[:, first].reshape(-1, 3), points[:, first + 1].reshape(-1, 3)
    lengths = np.linalg.norm(end - begin, axis=1)
    return 0.5 * (begin + end), turn_z_to((end - begin) / lengths[:, None]), lengths


def turn_z_to(direction: Array) -> Array:
    """Shortest rotations (n, 4), w first, that take z to unit directions (n, 3)."""
    wxyz = np.stack([1.0 + direction[:, 2], -direction[:, 1], direction[:, 0], np.zeros(len(direction))], axis=1)
    norm = np.linalg.norm(wxyz, axis=1, keepdims=True)
    opposite = norm[:, 0] < 1e-6
    wxyz[opposite], norm[opposite] = (0.0, 1.0, 0.0, 0.0), 1.0
    return np.asarray(wxyz / norm)


def centre_of_mass(robot: RobotDescription, frames: Array) -> Array:
    """(3,) in body, of the trunk and of each link half-way along it, for frames (legs, joints + 1, 4, 4)."""
    origins = frames[:, :, :3, 3]
    links = np.array([joint.mass for joint in robot.joints])
    middles = 0.5 * (origins[:, :-1] + origins[:, 1:])
    moment = robot.body.mass * np.asarray(robot.body.centre_of_mass_in_body) + np.einsum("j,ljk->k", links, middles)
    total: Array = moment / (robot.body.mass + robot.leg_count * links.sum())
    return total


def closed_hull(points: Array) -> Array:
    """Corners of the horizontal convex hull in order, the first repeated, (n, 3); empty below three points."""
    if len(points) < 3:
        return np.zeros((0, 3))
    order = points[np.lexsort((points[:, 1], points[:, 0]))]
    hull = _half_hull(order)[:-1] + _half_hull(order[::-1])[:-1]
    return np.array([*hull, hull[0]])


def _half_hull(points: Array) -> list[Array]:
    """Andrew's monotone chain: the hull's lower side for points sorted by x."""
    hull: list[Array] = []
    for point in points:
        while len(hull) > 1 and _turn(hull[-2], hull[-1], point) <= 0.0:
            hull.pop()
        hull.append(point)
    return hull


def _turn(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
