"""Planes and boxes on the graphics card, drawn front to back.

Software drawing pays for every pixel it shades: back to front a picture of the testbed costs three times as much.
"""

from __future__ import annotations

import moderngl
import numpy as np

from sim_agent.rendering.eye import Eye
from sim_agent.rendering.surfaces import VERTEX_FORMAT, Surface
from weaver_shared.transforms import Pose


class Blocks:
    """The quads of a surface, of which an eye gets those it can see."""

    def __init__(self, context: moderngl.Context, program: moderngl.Program, surface: Surface) -> None:
        self._quads = surface.indices.reshape(-1, 6)  # two triangles each
        corners = surface.vertices[surface.indices.reshape(-1, 6), :3].astype(np.float64)  # (n, 6, 3)
        self._centres = (corners.min(axis=1) + corners.max(axis=1)) / 2
        self._radius = np.linalg.norm(corners - self._centres[:, None], axis=2).max(axis=1)
        self._normals = surface.vertices[self._quads[:, 0], 3:6].astype(np.float64)
        self._indices = context.buffer(reserve=self._quads.nbytes)
        self._array = context.vertex_array(
            program,
            [(context.buffer(surface.vertices.tobytes()), *VERTEX_FORMAT)],
            index_buffer=self._indices,
        )

    def draw(self, eye: Eye, world_from_optical: Pose) -> None:
        from_eye = self._centres - world_from_optical.position
        faces = np.einsum("ij,ij->i", from_eye, self._normals) < 0.0
        seen = np.flatnonzero(faces & eye.sees(world_from_optical, self._centres, self._radius))
        # Half the size counts as distance, so that wide ground comes after what stands on it.
        away = np.linalg.norm(from_eye[seen], axis=1) + 0.5 * self._radius[seen]
        order = seen[np.argsort(away, kind="stable")]
        if order.size:
            self._indices.write(self._quads[order])
            self._array.render(vertices=6 * order.size)
