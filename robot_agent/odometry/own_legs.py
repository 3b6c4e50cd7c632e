"""Where the robot's own legs show in a picture: what is seen there moves with the robot, not with the ground."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.vision.camera import PinholeCamera
from robot_agent.vision.distortion import project
from weaver_shared.leg_batch import LegBatch
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.robots.reach import leg_length

Array = NDArray[np.float64]
Cover = NDArray[np.uint8]

COARSE = 4
"""Pixels along the side of a square that is hidden or not as a whole."""

THICKNESS = 0.1
"""Radius of a leg as a share of its length: 34 mm for one of 0.34 m, with servos, cables and some play."""

MARGIN = 8.0
"""px about a leg where a followed square of the picture would still show its edge."""

NEAREST = 0.04
"""m before the lens, where a leg is cut off."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnLegs:
    """The legs as sticks of one thickness, where they were when a picture was taken."""

    joint_in_body: Array  # (legs, joints + 1, 3) m, hips first, feet last
    radius: float  # m

    @staticmethod
    def of(robot: RobotDescription, legs: LegBatch) -> OwnLegs | None:
        """By the newest reading; None without one."""
        if not len(legs.stamp_ns) or not np.isfinite(legs.joint_position[-1]).all():
            return None
        return OwnLegs(
            joint_in_body=joint_frames_in_body(robot, legs.joint_position[-1])[..., :3, 3],
            radius=THICKNESS * leg_length(robot),
        )

    def cover(self, eye: PinholeCamera) -> Cover | None:
        """Squares of COARSE pixels of the eye's picture that show a leg (not zero); None where it shows none."""
        joints = self.joint_in_body
        if eye.distortion_model == "none" and not _in_sight(joints, self.radius, *_frustum(eye)):
            return None
        shape = joints.shape[:2]
        in_eye = eye.body_from_camera.inverse().transform(joints.reshape(-1, 3)).reshape(*shape, 3)
        begin, end = in_eye[:, :-1].reshape(-1, 3), in_eye[:, 1:].reshape(-1, 3)
        ahead = np.maximum(begin[:, 2], end[:, 2]) > NEAREST
        begin, end = _cut(begin[ahead], end[ahead]), _cut(end[ahead], begin[ahead])
        first, second = project(eye, begin), project(eye, end)
        first_px, second_px = (eye.fx * self.radius / points[:, 2] + MARGIN for points in (begin, end))
        widest = np.maximum(first_px, second_px)[:, None]
        lowest, highest = np.minimum(first, second) - widest, np.maximum(first, second) + widest
        shown = ((highest > 0.0) & (lowest < [eye.width, eye.height])).all(axis=1)
        if not shown.any():
            return None
        cover = np.zeros((-(-eye.height // COARSE), -(-eye.width // COARSE)), dtype=np.uint8)
        for row in np.flatnonzero(shown):
            cv2.fillConvexPoly(cover, _outline(first[row], second[row], first_px[row], second_px[row]), 1)
        return cover


def _frustum(eye: PinholeCamera) -> tuple[Array, Array, Array]:
    """Rotation and position of the eye, and its picture's bounds (4,) on the plane z = 1: left, right, top, bottom."""
    pose = eye.body_from_camera
    left, right = (-MARGIN - eye.cx) / eye.fx, (eye.width + MARGIN - eye.cx) / eye.fx
    top, bottom = (-MARGIN - eye.cy) / eye.fy, (eye.height + MARGIN - eye.cy) / eye.fy
    return np.ascontiguousarray(pose.rotation), pose.position, np.array([left, right, top, bottom])


@compiled
def _in_sight(joints: Array, radius: float, rotation: Array, position: Array, bounds: Array) -> bool:
    """Does some stick between `joints` (legs, m, 3) perhaps reach into the picture?

    Not where both its ends lie beyond one and the same side of what the picture shows.
    """
    outside = np.empty((2, 5), dtype=np.bool_)
    for leg in range(joints.shape[0]):
        for n in range(joints.shape[1]):
            x, y, z = 0.0, 0.0, 0.0
            for a in range(3):
                d = joints[leg, n, a] - position[a]
                x += rotation[a, 0] * d
                y += rotation[a, 1] * d
                z += rotation[a, 2] * d
            outside[1] = outside[0]
            outside[0, 0] = z < NEAREST - radius
            outside[0, 1] = bounds[0] * z - x > radius * np.sqrt(1.0 + bounds[0] ** 2)
            outside[0, 2] = x - bounds[1] * z > radius * np.sqrt(1.0 + bounds[1] ** 2)
            outside[0, 3] = bounds[2] * z - y > radius * np.sqrt(1.0 + bounds[2] ** 2)
            outside[0, 4] = y - bounds[3] * z > radius * np.sqrt(1.0 + bounds[3] ** 2)
            if n > 0 and not (outside[0] & outside[1]).any():
                return True
    return False


def hidden(cover: Cover | None, pixel: Array) -> NDArray[np.bool_]:
    """Which pixels (n, 2) lie on a leg."""
    if cover is None:
        return np.zeros(len(pixel), dtype=np.bool_)
    square = np.nan_to_num(pixel / COARSE, nan=-1.0).astype(np.int64)
    column = np.clip(square[:, 0], 0, cover.shape[1] - 1)
    row = np.clip(square[:, 1], 0, cover.shape[0] - 1)
    return np.asarray(cover[row, column] > 0)


def _cut(point: Array, other: Array) -> Array:
    """Points (n, 3) of sticks to `other`, those too near the lens or behind it moved along to NEAREST."""
    share = (NEAREST - point[:, 2]) / np.where(other[:, 2] == point[:, 2], 1.0, other[:, 2] - point[:, 2])
    return np.where(point[:, 2:] < NEAREST, point + np.clip(share, 0.0, 1.0)[:, None] * (other - point), point)


def _outline(first: Array, second: Array, first_px: float, second_px: float) -> NDArray[np.int32]:
    """Outline (m, 1, 2) of two discs and what lies between them, in squares."""
    turn = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    rims = np.concatenate([first + first_px * circle, second + second_px * circle]) / COARSE
    return np.asarray(cv2.convexHull(np.clip(rims, -1e4, 1e4).round().astype(np.int32)), dtype=np.int32)
