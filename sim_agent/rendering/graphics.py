"""A world and a robot on the graphics card, drawn into any eye."""

from __future__ import annotations

import os
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from sim_agent.rendering.blocks import Blocks
from sim_agent.rendering.eye import Eye
from sim_agent.rendering.relief import Relief
from sim_agent.rendering.robot_parts import RobotParts, unit_shapes
from sim_agent.rendering.shaders import FRAGMENT, GROUND_VERTEX, ROBOT_VERTEX
from sim_agent.rendering.surfaces import static_surface
from sim_agent.rendering.textures import ROBOT, SIZE, material_texture
from sim_agent.worlds import Material, World
from weaver_shared.errors import ResourceError
from weaver_shared.messages import SceneState
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

SKY_GREY = 0.80
SKY_COLOUR = (0.72, 0.80, 0.90)
# Slim systems have the libraries but not the unversioned names that point to them.
EGL: dict[str, Any] = {"backend": "egl", "libgl": "libGL.so.1", "libegl": "libEGL.so.1"}
TINTS = 8  # as many as the shaders declare


def open_context() -> moderngl.Context:
    """An off-screen context on EGL. Raises ResourceError where there is none."""
    # One software-rendering thread costs the least processor time and leaves the other core to the robot.
    os.environ.setdefault("LP_NUM_THREADS", "1")
    try:
        return moderngl.create_context(standalone=True, **EGL)
    except Exception as error:  # moderngl raises nothing more specific
        raise ResourceError(
            f"no off-screen graphics ({error}); install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri"
        ) from error


class Graphics:
    """Geometry and textures of one world, and the moving robot in it."""

    def __init__(self, robot: RobotDescription, world: World) -> None:
        self.context = open_context()
        self.context.enable(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        # Pictures are drawn upside down so that their first row comes first, which turns triangles round.
        self.context.front_face = "cw"
        self._parts = RobotParts(robot)
        materials = (*world.materials, ROBOT)
        layers = {material.name: index for index, material in enumerate(materials)}
        self._load_textures(materials, world.seed)
        self._ground = self._program(GROUND_VERTEX, materials)
        self._robot = self._program(ROBOT_VERTEX, materials)
        self._robot["robot_layer"] = float(layers[ROBOT.name])
        self._blocks = Blocks(self.context, self._ground, static_surface(world, layers))
        self._reliefs = [
            Relief(self.context, self._ground, field, layers[field.material]) for field in world.heightfields
        ]
        self._shapes = {name: self._shape(vertices) for name, vertices in unit_shapes().items()}

    def place_robot(self, scene: SceneState) -> None:
        """Move the robot to where it is for the pictures to come."""
        placements = self._parts.placements(scene.world_from_body, scene.joint_position)
        for name, matrices in placements.items():
            _, instances, _ = self._shapes[name]
            columns = np.ascontiguousarray(np.swapaxes(matrices, 1, 2))
            instances.orphan(columns.nbytes)
            instances.write(columns)
            self._shapes[name] = (self._shapes[name][0], instances, len(matrices))

    def draw(self, eye: Eye, world_from_optical: Pose, *, colour: bool) -> None:
        """Draw everything into the viewport of the bound frame buffer, which the caller has cleared."""
        columns = tuple(eye.clip_from_world(world_from_optical).T.ravel())
        for program in (self._ground, self._robot):
            program["clip_from_world"] = columns
            program["colour"] = float(colour)
            program["sky"] = SKY_COLOUR if colour else (SKY_GREY,) * 3
        self._textures.use(0)
        for vertex_array, _, count in self._shapes.values():
            vertex_array.render(instances=count)
        for relief in self._reliefs:
            relief.draw(eye, world_from_optical)
        self._blocks.draw(eye, world_from_optical)

    def close(self) -> None:
        self.context.release()

    def _program(self, vertex: str, materials: tuple[Material, ...]) -> moderngl.Program:
        program = self.context.program(vertex_shader=vertex, fragment_shader=FRAGMENT)
        tints = [material.tint for material in materials]
        program["tints"] = tints + [(1.0, 1.0, 1.0)] * (TINTS - len(tints))
        return program

    def _load_textures(self, materials: tuple[Material, ...], seed: int) -> None:
        pictures = [
            material_texture(material, np.random.default_rng([seed, 20, index]))
            for index, material in enumerate(materials)
        ]
        self._textures = self.context.texture_array((SIZE, SIZE, len(pictures)), 1, np.stack(pictures).tobytes())
        self._textures.build_mipmaps()
        # Trilinear; anisotropy would cost llvmpipe five times the whole picture.
        self._textures.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        self._textures.repeat_x = self._textures.repeat_y = True

    def _shape(self, vertices: NDArray[np.float32]) -> tuple[moderngl.VertexArray, moderngl.Buffer, int]:
        instances = self.context.buffer(reserve=64)
        vertex_array = self.context.vertex_array(
            self._robot,
            [
                (self.context.buffer(vertices.tobytes()), "3f 3f", "position", "normal"),
                (instances, "16f/i", "world_from_shape"),
            ],
        )
        return vertex_array, instances, 0
