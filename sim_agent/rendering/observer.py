"""Pictures of the robot from outside, for people: documentation, tests seen by eye, reports."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sim_agent.rendering.eye import Eye
from sim_agent.rendering.graphics import SKY_COLOUR, Graphics
from sim_agent.worlds import World
from weaver_shared.messages import SceneState
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

FIELD_OF_VIEW = np.deg2rad(50.0)
BESIDE = (-0.9, -1.1, 0.75)
"""Where an observer stands from the robot unless told otherwise (m, in axes of the world)."""


class Observer:
    """A colour camera that looks at the robot from a place of its own. Raises ResourceError without EGL."""

    def __init__(self, robot: RobotDescription, world: World, *, width: int = 960, height: int = 640) -> None:
        focal_length = 0.5 * width / float(np.tan(FIELD_OF_VIEW / 2))
        self._eye = Eye(
            width=width,
            height=height,
            intrinsics=(focal_length, focal_length, (width - 1) / 2, (height - 1) / 2),
        )
        self._graphics = Graphics(robot, world)
        context = self._graphics.context
        size = (width, height)
        self._frame = context.framebuffer([context.renderbuffer(size, components=3)], context.depth_renderbuffer(size))

    def picture(self, scene: SceneState, offset: ArrayLike = BESIDE) -> NDArray[np.uint8]:
        """The robot seen from its position plus `offset` (3,) in m, as RGB (height, width, 3)."""
        target = scene.position_in_world + np.array([0.0, 0.0, 0.03])
        eye = target + np.asarray(offset, dtype=np.float64)
        self._graphics.place_robot(scene)
        self._frame.use()
        self._frame.clear(*SKY_COLOUR)
        self._graphics.draw(self._eye, looking_at(eye, target), colour=True)
        data = self._frame.read(components=3, alignment=1)
        return np.frombuffer(data, dtype=np.uint8).reshape(self._eye.height, self._eye.width, 3)

    def close(self) -> None:
        self._graphics.close()


def looking_at(eye: ArrayLike, target: ArrayLike) -> Pose:
    """World from an optical frame at `eye` (3,) whose axis meets `target` (3,), the picture's top upwards."""
    position = np.asarray(eye, dtype=np.float64)
    forward = np.asarray(target, dtype=np.float64) - position
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, np.array([0.0, 0.0, 1.0]))
    right /= np.linalg.norm(right)
    return Pose(rotation=np.column_stack([right, np.cross(forward, right), forward]), position=position)
