"""Where a simulated robot really is: its own figure once more, translucent, for comparison with what it believes."""

from __future__ import annotations

from typing import Any

import numpy as np

from weaver_console.scene.link_meshes import add_links
from weaver_console.scene.node_values import assign, place
from weaver_console.scene.posture import Posture
from weaver_shared.messages import TruthState
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body

WIDTH = 0.03
"""m of a link, a little more than the figure's: where both coincide, one shines through about the other."""

_LOOK: dict[str, Any] = {"opacity": 0.35, "cast_shadow": False, "receive_shadow": False}
_COLOUR = (214, 232, 255)


class GhostFigure:
    """Lives under a frame `name`. The scene is a viser SceneApi; without truth nothing of it is sent."""

    def __init__(self, scene: Any, name: str, robot: RobotDescription) -> None:
        self._frame = scene.add_frame(name, show_axes=False, visible=False)
        self._shown: Posture | None = None
        frames = joint_frames_in_body(robot, np.zeros(robot.joint_count))
        self._links = add_links(scene, f"{name}/links", frames, WIDTH, _COLOUR, **_LOOK)
        scene.add_box(
            f"{name}/body", color=_COLOUR, dimensions=robot.body.size, position=robot.body.box_in_body, **_LOOK
        )

    def update(self, truth: TruthState | None, posture: Posture) -> None:
        """At the true pose, with the joints as the robot tells them."""
        if self._frame.visible != (truth is not None):
            self._frame.visible = truth is not None
        if truth is None:
            return
        place(self._frame, truth.position_in_world, truth.wxyz)
        if posture is not self._shown:
            self._shown = posture
            middles, wxyzs = posture.links
            assign(self._links, batched_positions=middles, batched_wxyzs=wxyzs)
