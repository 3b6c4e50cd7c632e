"""The robot as it shows in its own pictures: boxes, tubes and balls on its links."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_agent.model import leg_links, link_poses
from sim_agent.model.links import HUB, LEG_LENGTH
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.robots.reach import leg_length
from weaver_shared.transforms import Pose, rotation_y

Array = NDArray[np.float64]

TUBE_SIDES = 10
BALL_RINGS = 6
EYE_BAR = 0.014  # m, half thickness of the camera's case


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """A unit shape stretched by `link_from_shape` (4, 4), fixed to leg link `link` of every leg, or to the trunk."""

    shape: str  # "box", "tube" or "ball"
    link: int | None
    link_from_shape: Array


class RobotParts:
    """Where all parts are for a pose and joint angles."""

    def __init__(self, robot: RobotDescription) -> None:
        self._robot = robot
        self._links = leg_links(robot)
        self._parts = _parts(robot)

    def placements(self, world_from_body: Pose, joint_position: Array) -> dict[str, NDArray[np.float32]]:
        """For each shape the matrices (n, 4, 4) world_from_shape."""
        frames = joint_frames_in_body(self._robot, joint_position)
        world_from_link = world_from_body.matrix @ link_poses(self._robot, self._links, frames)
        found: dict[str, list[Array]] = {"box": [], "tube": [], "ball": []}
        for part in self._parts:
            if part.link is None:
                found[part.shape].append((world_from_body.matrix @ part.link_from_shape)[None])
            else:
                found[part.shape].append(world_from_link[:, part.link] @ part.link_from_shape)
        return {shape: np.concatenate(matrices).astype(np.float32) for shape, matrices in found.items() if matrices}


def _parts(robot: RobotDescription) -> tuple[Part, ...]:
    body = robot.body
    parts = [
        Part(shape="box", link=None, link_from_shape=_stretched(np.array(body.box_in_body), np.array(body.size) / 2))
    ]
    if robot.has_camera:
        parts += _camera_mount(robot)
    hub = HUB * leg_length(robot) / LEG_LENGTH
    for link in leg_links(robot):
        if link.length == 0.0:
            parts.append(Part(shape="box", link=link.index, link_from_shape=_stretched(np.zeros(3), np.full(3, hub))))
            continue
        parts.append(Part(shape="tube", link=link.index, link_from_shape=_along(link.end, link.radius)))
        radius = robot.foot_radius if link.is_foot else link.radius
        parts.append(Part(shape="ball", link=link.index, link_from_shape=_stretched(link.end, np.full(3, radius))))
    return tuple(parts)


def _camera_mount(robot: RobotDescription) -> list[Part]:
    """A bar just behind both eyes, on a mast; neither reaches into their view."""
    camera = robot.camera
    eyes = np.array(camera.position_in_body)
    rotation = rotation_y(camera.pitch_down)
    bar = np.eye(4)
    bar[:3, :3] = rotation * np.array([EYE_BAR, camera.baseline / 2 + 0.02, EYE_BAR])
    bar[:3, 3] = eyes - rotation[:, 0] * 2.0 * EYE_BAR
    foot = robot.body.box_in_body[2] + robot.body.size[2] / 2
    middle = np.array([bar[0, 3], 0.0, (bar[2, 3] + foot) / 2])
    mast = _stretched(middle, np.array([EYE_BAR, EYE_BAR, abs(bar[2, 3] - foot) / 2]))
    return [Part(shape="box", link=None, link_from_shape=matrix) for matrix in (bar, mast)]


def _stretched(centre: Array, half: Array) -> Array:
    matrix = np.diag([*half, 1.0])
    matrix[:3, 3] = centre
    return matrix


def _along(end: Array, radius: float) -> Array:
    """A tube of unit radius along z from -1 to 1, laid from the origin to `end`."""
    length = float(np.linalg.norm(end))
    z = end / length
    x = np.cross(np.array([0.0, 1.0, 0.0]), z)
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = x * radius, np.cross(z, x) * radius, z * length / 2
    matrix[:3, 3] = end / 2
    return matrix


def unit_shapes() -> dict[str, NDArray[np.float32]]:
    """Triangle lists of the shapes, (n, 6) of position and normal, counter-clockwise from outside."""
    return {"box": _box(), "tube": _tube(), "ball": _ball()}


def _box() -> NDArray[np.float32]:
    faces = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            corners = np.zeros((4, 3))
            corners[:, axis] = sign
            corners[:, (axis + 1) % 3] = [-1, 1, 1, -1]
            corners[:, (axis + 2) % 3] = np.array([-1, -1, 1, 1]) * sign
            faces.append(_with_normals(corners[[0, 1, 2, 0, 2, 3]], np.tile(np.eye(3)[axis] * sign, (6, 1))))
    return np.concatenate(faces)


def _tube() -> NDArray[np.float32]:
    angle = np.linspace(0.0, 2.0 * np.pi, TUBE_SIDES + 1)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    low = np.column_stack([ring, np.full(len(ring), -1.0)])
    high = np.column_stack([ring, np.full(len(ring), 1.0)])
    side = np.column_stack([ring, np.zeros(len(ring))])
    positions = np.concatenate(
        [[low[i], low[i + 1], high[i + 1], low[i], high[i + 1], high[i]] for i in range(TUBE_SIDES)]
    )
    normals = np.concatenate(
        [[side[i], side[i + 1], side[i + 1], side[i], side[i + 1], side[i]] for i in range(TUBE_SIDES)]
    )
    return _with_normals(positions, normals)


def _ball() -> NDArray[np.float32]:
    polar = np.linspace(0.0, np.pi, BALL_RINGS + 1)
    around = np.linspace(0.0, 2.0 * np.pi, TUBE_SIDES + 1)
    grid = np.stack(
        [
            np.sin(polar)[:, None] * np.cos(around)[None, :],
            np.sin(polar)[:, None] * np.sin(around)[None, :],
            np.broadcast_to(np.cos(polar)[:, None], (polar.size, around.size)),
        ],
        axis=-1,
    )
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    positions = np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3)
    return _with_normals(positions, positions)


def _with_normals(positions: Array, normals: Array) -> NDArray[np.float32]:
    return np.hstack([positions, normals]).astype(np.float32)
