"""The robot's solid parts, derived from its description: what collides, what weighs and what the cameras see."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.robots import RobotDescription
from weaver_shared.robots.reach import leg_length

Array = NDArray[np.float64]

RADII = (0.024, 0.022, 0.020, 0.014)
"""Capsule radii from the first link with a length to the foot (m, chosen after the servos' cases)."""

LEG_LENGTH = 0.34
"""Leg that the radii are meant for (m); those of other robots are in proportion."""

KNEE_GAP = 0.35
"""Share of the first pitching link left without collision, so that a sitting robot's hips may touch the ground."""

HUB = 0.022
"""Half edge of the block drawn where joint axes meet (m)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """One link of every leg, in its own frame: origin on its joint's axis, z along the axis.

    `end` is where the next joint (or the foot) sits; `next_rotation` turns the next DH frame into this one. It is a
    rotation about x, so that of a mirrored leg is its inverse.
    """

    index: int
    name: str
    mass: float
    end: Array  # (3,) m
    next_rotation: Array  # (3, 3)
    radius: float
    is_foot: bool
    collides: bool
    collision_begin: float  # share of the way to `end` where the collision capsule starts

    @property
    def length(self) -> float:
        return float(np.linalg.norm(self.end))

    @property
    def inertia(self) -> Array:
        """Principal moments about the middle of the link, (3,) kg m^2; a box as long as the link."""
        along = 2.0 * self.radius + np.abs(self.end)
        square = along**2
        moments: Array = self.mass / 12.0 * (square.sum() - square)
        return moments


def leg_links(robot: RobotDescription) -> tuple[Link, ...]:
    """The links of one leg, hip first; all legs share them."""
    lengths = [float(np.hypot(joint.d, joint.r)) for joint in robot.joints]
    size = leg_length(robot) / LEG_LENGTH
    with_length = [index for index, length in enumerate(lengths) if length > 0.0]
    pitching = [index for index in with_length if robot.joints[index].r > 0.0]
    links = []
    for index, joint in enumerate(robot.joints):
        ca, sa = np.cos(joint.alpha), np.sin(joint.alpha)
        order = with_length.index(index) if index in with_length else 0
        links.append(
            Link(
                index=index,
                name=joint.name,
                mass=joint.mass,
                end=np.array([joint.r, 0.0, joint.d]),
                next_rotation=np.array([[1.0, 0.0, 0.0], [0.0, ca, -sa], [0.0, sa, ca]]),
                radius=size * (RADII[min(order, len(RADII) - 1)] if index != len(robot.joints) - 1 else RADII[-1]),
                is_foot=index == len(robot.joints) - 1,
                collides=index in pitching,
                collision_begin=KNEE_GAP if pitching and index == pitching[0] else 0.0,
            )
        )
    return tuple(links)


def link_poses(robot: RobotDescription, links: tuple[Link, ...], frames_in_body: Array) -> Array:
    """Link frames in body (legs, joints, 4, 4) from the DH frames (legs, joints + 1, 4, 4) of forward kinematics."""
    end_from_link = np.zeros((robot.leg_count, len(links), 4, 4))
    for leg, side in enumerate(robot.sides):
        for link in links:
            rotation = (link.next_rotation if side > 0.0 else link.next_rotation.T).T
            end_from_link[leg, link.index, :3, :3] = rotation
            end_from_link[leg, link.index, :3, 3] = -rotation @ link.end
            end_from_link[leg, link.index, 3, 3] = 1.0
    poses: Array = frames_in_body[:, 1:] @ end_from_link
    return poses
