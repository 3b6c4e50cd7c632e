"""The robot as a few batched shapes, all links at once: 0.1 ms an update where a node for each link takes ten times."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.layers import TORQUE
from weaver_console.scene.link_meshes import add_links
from weaver_console.scene.node_values import assign, place
from weaver_console.scene.posture import Posture, visible_links
from weaver_console.scene.shapes import octasphere, upright
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body

Array = NDArray[np.float64]

LINK_WIDTH = 0.026
JOINT_RADIUS = 0.021

_BODY_COLOUR = (58, 66, 78)
_EYE_COLOUR = (20, 22, 26)
_LINK_COLOUR = (214, 138, 52)
_JOINT_COLOUR = (44, 48, 56)
_CONTACT_COLOUR = (52, 199, 129)
_SWING_COLOUR = (236, 236, 240)
_STILL = {"cast_shadow": False, "receive_shadow": False}


class RobotFigure:
    """Lives under a frame `name`; `update` moves it. The scene is a viser SceneApi."""

    def __init__(self, scene: Any, name: str, robot: RobotDescription) -> None:
        self._robot = robot
        self._frame = scene.add_frame(name, show_axes=False)
        self._add_body(scene, name)
        frames = joint_frames_in_body(robot, np.zeros(robot.joint_count))
        self._first = visible_links(frames)
        self._links = add_links(scene, f"{name}/links", frames, LINK_WIDTH, _LINK_COLOUR, **_STILL)
        shape = {"lod": "off", **_STILL}
        ball, ball_faces = octasphere()
        joints = frames[:, :-1, :3, 3].reshape(-1, 3)
        self._joints = scene.add_batched_meshes_simple(
            f"{name}/joints", ball, ball_faces, upright(len(joints)), joints,
            batched_scales=np.full(len(joints), JOINT_RADIUS), batched_colors=_JOINT_COLOUR, **shape,
        )  # fmt: skip
        self._feet = scene.add_batched_meshes_simple(
            f"{name}/feet", ball, ball_faces, upright(robot.leg_count), frames[:, -1, :3, 3],
            batched_scales=np.full(robot.leg_count, 1.25 * robot.foot_radius), batched_colors=_SWING_COLOUR, **shape,
        )  # fmt: skip
        self._contact: NDArray[np.bool_] | None = None
        self._stall = np.tile([robot.servos[joint.servo].stall_torque for joint in robot.joints], robot.leg_count)
        self._joint_colours = np.array(_JOINT_COLOUR, dtype=np.uint8)

    def _add_body(self, scene: Any, name: str) -> None:
        robot = self._robot
        scene.add_box(f"{name}/body", color=_BODY_COLOUR, dimensions=robot.body.size, position=robot.body.box_in_body,
                      **_STILL)  # fmt: skip
        if robot.has_camera:
            eyes = robot.camera
            scene.add_box(f"{name}/eyes", color=_EYE_COLOUR, dimensions=(eyes.baseline + 0.04, 0.035, 0.03),
                          wxyz=eyes.body_from_left.wxyz, position=eyes.position_in_body, **_STILL)  # fmt: skip
        top = robot.body.box_in_body[2] + 0.5 * robot.body.size[2]
        stripe = (0.12 * robot.body.size[0], 0.9 * robot.body.size[1], 0.004)
        place = (0.42 * robot.body.size[0], 0.0, top)
        scene.add_box(f"{name}/front", color=_LINK_COLOUR, dimensions=stripe, position=place, **_STILL)

    def torque(self, torque: Array | None) -> None:
        """Colour every joint and the link it moves by its share of the servo's stall torque; None as usual."""
        if torque is None or torque.shape != self._stall.shape:
            joints, links = np.array(_JOINT_COLOUR, dtype=np.uint8), np.array(_LINK_COLOUR, dtype=np.uint8)
        else:
            joints = TORQUE.colours(np.abs(torque) / self._stall)
            links = joints.reshape(self._robot.leg_count, -1, 3)[:, self._first].reshape(-1, 3)
        if not np.array_equal(joints, self._joint_colours):
            self._joint_colours = joints
            self._joints.batched_colors, self._links.batched_colors = joints, links

    def update(self, posture: Posture) -> None:
        """Show how the robot stands, and which feet touch the ground."""
        state = posture.state
        middles, wxyzs = posture.links
        place(self._frame, state.position_in_world, state.wxyz)
        assign(self._links, batched_positions=middles, batched_wxyzs=wxyzs)
        assign(self._joints, batched_positions=posture.joints)
        assign(self._feet, batched_positions=posture.feet)
        contact = state.foot_contact
        if self._contact is None or not np.array_equal(contact, self._contact):
            self._contact = contact
            colours = np.where(contact[:, None], _CONTACT_COLOUR, _SWING_COLOUR)
            self._feet.batched_colors = colours.astype(np.uint8)

    def remove(self) -> None:
        self._frame.remove()
