"""A heightfield on the graphics card, coarser with distance: triangles, not pixels, are what software drawing costs."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from sim_agent.rendering.eye import Eye
from sim_agent.rendering.surfaces import VERTEX_FORMAT, grid_indices, heightfield_vertices
from sim_agent.worlds import Heightfield
from weaver_shared.transforms import Pose

TILE = 16  # cells; a multiple of the coarsest stride, or holes would open between tiles
STRIDES = (1, 2, 4, 8)
REACH = (2.5, 5.0, 9.0)
"""Distance (m) up to which a tile is drawn at each stride but the last."""


class Relief:
    def __init__(self, context: moderngl.Context, program: moderngl.Program, field: Heightfield, layer: int) -> None:
        rows, columns = ((n - 1) // TILE for n in field.z.shape)
        vertices = heightfield_vertices(field, layer)
        buffer = context.buffer(vertices.tobytes())
        self._ranges: list[tuple[NDArray[np.int64], NDArray[np.int64]]] = []
        self._arrays: list[moderngl.VertexArray] = []
        for stride in STRIDES:
            blocks = [
                grid_indices(_nodes(i, stride), _nodes(j, stride), field.z.shape[1]).reshape(-1)
                for i in range(rows)
                for j in range(columns)
            ]
            count = np.array([block.size for block in blocks])
            self._ranges.append((np.concatenate([[0], np.cumsum(count)[:-1]]), count))
            self._arrays.append(
                context.vertex_array(
                    program,
                    [(buffer, *VERTEX_FORMAT)],
                    index_buffer=context.buffer(np.concatenate(blocks).tobytes()),
                )
            )
        nodes = vertices[:, :3].reshape(*field.z.shape, 3).astype(np.float64)
        corners = [
            (nodes[i * TILE, j * TILE], nodes[(i + 1) * TILE, (j + 1) * TILE])
            for i in range(rows)
            for j in range(columns)
        ]
        self._centres = np.array([(low + high) / 2 for low, high in corners])
        relief = float(np.ptp(field.z))
        self._radius = np.full(len(corners), np.hypot(TILE * field.cell / np.sqrt(2.0), relief))

    def draw(self, eye: Eye, world_from_optical: Pose) -> None:
        seen = np.flatnonzero(eye.sees(world_from_optical, self._centres, self._radius))
        away = self._centres[seen] - world_from_optical.position
        distance = np.hypot(away[:, 0], away[:, 1])
        nearest_first = np.argsort(distance, kind="stable")
        level = np.searchsorted(REACH, distance)
        for tile, which in zip(seen[nearest_first], level[nearest_first], strict=True):
            first, count = self._ranges[which]
            self._arrays[which].render(vertices=int(count[tile]), first=int(first[tile]))


def _nodes(tile: int, stride: int) -> NDArray[np.int64]:
    return np.arange(tile * TILE, (tile + 1) * TILE + 1, stride)
