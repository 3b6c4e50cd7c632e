"""Pictures without OpenGL: PyBullet's software renderer at 320x240, enlarged. A fall-back, slow and coarse."""

from __future__ import annotations

import tempfile
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from sim_agent.model import robot_urdf
from sim_agent.physics.quiet import quiet
from sim_agent.rendering.eye import Eye
from sim_agent.rendering.surfaces import Surface, grid_indices, heightfield_vertices, static_surface
from sim_agent.rendering.textures import material_texture
from sim_agent.worlds import World
from weaver_shared.messages import SceneState
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

with quiet():
    import pybullet

Picture = NDArray[np.uint8]

WIDTH, HEIGHT = 320, 240
TEXTURE_SIZE = 512  # texels of PyBullet's textures, which have no mip-maps


class TinyPair:
    """Both eyes one after the other in a PyBullet client of its own."""

    def __init__(self, robot: RobotDescription, world: World) -> None:
        self._camera = robot.camera
        fx, fy, cx, cy = robot.camera.intrinsics
        sx, sy = WIDTH / robot.camera.width, HEIGHT / robot.camera.height
        self._eye = Eye(
            width=WIDTH,
            height=HEIGHT,
            intrinsics=(fx * sx, fy * sy, (cx + 0.5) * sx - 0.5, (cy + 0.5) * sy - 0.5),
        )
        self._client = pybullet.connect(pybullet.DIRECT)
        with tempfile.TemporaryDirectory() as folder, quiet():
            self._load_world(world, Path(folder))
            path = Path(folder) / "robot.urdf"
            path.write_text(robot_urdf(robot))
            self._body = pybullet.loadURDF(str(path), physicsClientId=self._client)
        self._joints = self._joint_indices(robot)

    def draw(self, scene: SceneState) -> Picture:
        self._place(scene)
        eyes = (self._camera.body_from_left, self._camera.body_from_right)
        pictures = [self._look(scene.world_from_body @ mount) for mount in eyes]
        size = (self._camera.width, self._camera.height)
        return np.hstack([cv2.resize(picture, size, interpolation=cv2.INTER_LINEAR) for picture in pictures])

    def close(self) -> None:
        if pybullet.isConnected(self._client):
            pybullet.disconnect(self._client)

    def _look(self, world_from_optical: Pose) -> Picture:
        # PyBullet's camera looks along -z with y up and its pictures begin with the top row.
        upright = np.diag([1.0, -1.0, 1.0, 1.0]) @ self._eye.clip_from_optical @ np.diag([1.0, -1.0, -1.0, 1.0])
        view = np.diag([1.0, -1.0, -1.0, 1.0]) @ world_from_optical.inverse().matrix
        _, _, rgba, _, _ = pybullet.getCameraImage(
            WIDTH,
            HEIGHT,
            viewMatrix=view.T.ravel().tolist(),
            projectionMatrix=upright.T.ravel().tolist(),
            lightDirection=[0.4, 0.3, 1.0],
            shadow=0,
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=self._client,
        )
        pixels = np.asarray(rgba, dtype=np.uint8).reshape(HEIGHT, WIDTH, 4)
        grey: Picture = cv2.cvtColor(pixels, cv2.COLOR_RGBA2GRAY)
        return grey

    def _place(self, scene: SceneState) -> None:
        w, x, y, z = scene.wxyz
        body, client = self._body, self._client
        centre = np.asarray(pybullet.getDynamicsInfo(body, -1, physicsClientId=client)[3])
        position = scene.world_from_body.transform(centre)
        pybullet.resetBasePositionAndOrientation(body, position.tolist(), [x, y, z, w], physicsClientId=client)
        for index, angle in zip(self._joints, scene.joint_position, strict=True):
            pybullet.resetJointState(body, index, float(angle), physicsClientId=client)

    def _load_world(self, world: World, folder: Path) -> None:
        layers = {material.name: index for index, material in enumerate(world.materials)}
        surfaces = [static_surface(world, layers)]
        for field in world.heightfields:
            nodes = [np.arange(n) for n in field.z.shape]
            surfaces.append(
                Surface(
                    vertices=heightfield_vertices(field, layers[field.material]),
                    indices=grid_indices(nodes[0], nodes[1], field.z.shape[1]),
                )
            )
        for material in world.materials:
            texture = material_texture(material, np.random.default_rng([world.seed, 20, layers[material.name]]))
            picture = folder / f"{material.name}.png"
            cv2.imwrite(str(picture), cv2.resize(texture, (TEXTURE_SIZE,) * 2, interpolation=cv2.INTER_AREA))
            texture_id = pybullet.loadTexture(str(picture), physicsClientId=self._client)
            for number, surface in enumerate(surfaces):
                path = folder / f"{material.name}_{number}.obj"
                if _write_obj(path, surface, layers[material.name]):
                    shape = pybullet.createVisualShape(
                        pybullet.GEOM_MESH, fileName=str(path), physicsClientId=self._client
                    )
                    body = pybullet.createMultiBody(0.0, -1, shape, physicsClientId=self._client)
                    pybullet.changeVisualShape(
                        body, -1, textureUniqueId=texture_id, rgbaColor=[1, 1, 1, 1], physicsClientId=self._client
                    )

    def _joint_indices(self, robot: RobotDescription) -> list[int]:
        count = pybullet.getNumJoints(self._body, physicsClientId=self._client)
        names = [pybullet.getJointInfo(self._body, i, physicsClientId=self._client)[1].decode() for i in range(count)]
        return [names.index(name) for name in robot.joint_names]


def _write_obj(path: Path, surface: Surface, layer: int) -> bool:
    """Write the triangles of one texture layer; False if there are none."""
    triangles = surface.indices[surface.vertices[surface.indices[:, 0], 8] == layer]
    if not len(triangles):
        return False
    used, renumbered = np.unique(triangles, return_inverse=True)
    vertices = surface.vertices[used]
    lines = ["v {:.5f} {:.5f} {:.5f}".format(*vertex[0:3]) for vertex in vertices]
    lines += ["vn {:.4f} {:.4f} {:.4f}".format(*vertex[3:6]) for vertex in vertices]
    lines += ["vt {:.5f} {:.5f}".format(*vertex[6:8]) for vertex in vertices]
    corners = renumbered.reshape(-1, 3) + 1
    lines += ["f " + " ".join(f"{n}/{n}/{n}" for n in corner) for corner in corners]
    path.write_text("\n".join(lines))
    return True
