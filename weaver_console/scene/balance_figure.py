"""Centre of mass, where it weighs on the ground, and how far that is from the edge of the support polygon."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.lines import NONE, Lines
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body

Array = NDArray[np.float64]

RADIUS = 0.018
_MASS = (250, 204, 21)
_STABLE, _UNSTABLE = (52, 199, 129), (239, 83, 80)


class BalanceFigure:
    def __init__(self, scene: Any, name: str, robot: RobotDescription) -> None:
        self._robot = robot
        still = {"cast_shadow": False, "receive_shadow": False}
        self._mass = scene.add_icosphere(f"{name}/mass", RADIUS, _MASS, subdivisions=1, visible=False, **still)
        self._plumb = Lines(scene, f"{name}/plumb", _MASS, thickness=0.004)
        self._margin = Lines(scene, f"{name}/margin", _STABLE, thickness=0.008)
        self._label = scene.add_label(f"{name}/label", "", visible=False, font_screen_scale=0.8, anchor="bottom-left")

    def update(self, world_from_body: Any, joint_position: Array, hull: Array, margin: float) -> None:
        """`hull` (n + 1, 3) is the closed support polygon in world, or empty; `margin` as the robot tells it, m."""
        mass = world_from_body.transform(centre_of_mass(self._robot, joint_position)[None])[0]
        self._mass.position, self._mass.visible = mass, True
        shown = len(hull) > 0 and np.isfinite(margin)
        self._label.visible = shown
        if not shown:
            self._plumb.show(NONE)
            self._margin.show(NONE)
            return
        foot = np.array([mass[0], mass[1], hull[:, 2].mean()])
        edge = nearest_on(hull, foot)
        self._plumb.chain(np.array([mass, foot]))
        self._margin.chain(np.array([foot, edge]))
        self._margin.colour(_STABLE if margin > 0.0 else _UNSTABLE)
        self._label.position = edge
        text = f"{margin:.2f} m"
        if self._label.text != text:
            self._label.text = text


def centre_of_mass(robot: RobotDescription, joint_position: Array) -> Array:
    """(3,) in body: the trunk's, and each link's mass half-way along it."""
    origins = joint_frames_in_body(robot, joint_position)[:, :, :3, 3]
    links = np.array([joint.mass for joint in robot.joints])
    middles = 0.5 * (origins[:, :-1] + origins[:, 1:])
    moment = robot.body.mass * np.asarray(robot.body.centre_of_mass_in_body) + np.einsum("j,ljk->k", links, middles)
    total: Array = moment / (robot.body.mass + robot.leg_count * links.sum())
    return total


def nearest_on(chain: Array, place: Array) -> Array:
    """The point (3,) of a line through points (n, 3) that is nearest to a place, seen from above."""
    begin, along = chain[:-1], np.diff(chain, axis=0)
    length = np.maximum((along[:, :2] ** 2).sum(axis=1), 1e-12)
    share = np.clip(((place[:2] - begin[:, :2]) * along[:, :2]).sum(axis=1) / length, 0.0, 1.0)
    points = begin + share[:, None] * along
    return np.asarray(points[np.argmin(np.linalg.norm(points[:, :2] - place[:2], axis=1))])
