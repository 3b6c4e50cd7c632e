"""The robot's stereo camera: what its two eyes see of the world and of the robot itself."""

from __future__ import annotations

import logging
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sim_agent.rendering.eye import Eye
from sim_agent.rendering.graphics import SKY_GREY, Graphics
from sim_agent.rendering.noise import SensorNoise
from sim_agent.rendering.tiny import TinyPair
from sim_agent.worlds import World
from weaver_shared.errors import ResourceError
from weaver_shared.messages import SceneState, StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

logger = logging.getLogger(__name__)

Picture = NDArray[np.uint8]


class PairDrawer(Protocol):
    def draw(self, scene: SceneState) -> Picture:
        """Both eyes side by side, (height, 2 * width), without noise."""
        ...

    def close(self) -> None: ...


class StereoRenderer:
    """Renders scenes into `StereoFrame`s of the described camera's size.

    Draws with OpenGL where it can; otherwise with PyBullet's own renderer at a quarter of the resolution, which
    `warning` then says in a sentence. The same seed and scenes give the same bytes.
    """

    def __init__(self, robot: RobotDescription, world: World, seed: int, *, opengl: bool = True) -> None:
        camera = robot.camera
        self._width = camera.width
        self._noise = SensorNoise(2 * camera.width, camera.height, np.random.default_rng([seed, 30]))
        self.warning = ""
        self._pair: PairDrawer
        try:
            if not opengl:
                raise ResourceError("OpenGL was not asked for")
            self._pair = OpenGlPair(robot, world)
        except ResourceError as error:
            self.warning = f"pictures are drawn at 320x240 and enlarged, odometry will be poor: {error}"
            logger.warning("%s", self.warning)
            self._pair = TinyPair(robot, world)

    def render(self, scene: SceneState, sequence: int) -> StereoFrame:
        """The pair seen at `scene`, stamped with its stamp; `sequence` picks the noise."""
        both = self._noise.add(self._pair.draw(scene), sequence)
        return StereoFrame(
            stamp_ns=scene.stamp_ns,
            sequence=sequence,
            left=np.ascontiguousarray(both[:, : self._width]),
            right=np.ascontiguousarray(both[:, self._width :]),
        )

    def close(self) -> None:
        self._pair.close()


class OpenGlPair:
    """Both eyes in one frame buffer, read back at once."""

    def __init__(self, robot: RobotDescription, world: World) -> None:
        camera = robot.camera
        self._eye = Eye(width=camera.width, height=camera.height, intrinsics=camera.intrinsics)
        self._mounts = (camera.body_from_left, camera.body_from_right)
        self._graphics = Graphics(robot, world)
        context = self._graphics.context
        size = (2 * camera.width, camera.height)
        self._depth = context.depth_texture(size)
        self._frame = context.framebuffer([context.renderbuffer(size, components=1)], self._depth)
        self._buffer = np.zeros((camera.height, 2 * camera.width), dtype=np.uint8)

    def draw(self, scene: SceneState) -> Picture:
        self._graphics.place_robot(scene)
        self._frame.use()
        self._frame.viewport = (0, 0, 2 * self._eye.width, self._eye.height)
        self._frame.clear(SKY_GREY, SKY_GREY, SKY_GREY)
        for index, world_from_optical in enumerate(self._eyes(scene)):
            self._frame.viewport = (index * self._eye.width, 0, self._eye.width, self._eye.height)
            self._graphics.draw(self._eye, world_from_optical, colour=False)
        self._frame.viewport = (0, 0, 2 * self._eye.width, self._eye.height)
        self._frame.read_into(self._buffer, components=1, alignment=1)
        return self._buffer

    def depth(self, scene: SceneState) -> NDArray[np.float64]:
        """Distance along the optical axis in m, (height, 2 * width): truth for tests and evaluation."""
        self.draw(scene)
        raw = np.frombuffer(self._depth.read(alignment=1), dtype=np.float32).reshape(self._buffer.shape)
        projection = self._eye.clip_from_optical
        normalised = 2.0 * raw.astype(np.float64) - 1.0
        metres: NDArray[np.float64] = projection[2, 3] / (normalised - projection[2, 2])
        return metres

    def close(self) -> None:
        self._graphics.close()

    def _eyes(self, scene: SceneState) -> tuple[Pose, ...]:
        return tuple(scene.world_from_body @ mount for mount in self._mounts)


def frame_sequence(robot: RobotDescription, stamp_ns: int) -> int:
    """The number of the frame exposed at this stamp, counted on the control clock from its start."""
    return round(stamp_ns * 1e-9 * robot.camera.rate)
