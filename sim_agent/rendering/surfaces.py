"""A world's visible surfaces as textured triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_agent.rendering.textures import PERIOD
from sim_agent.worlds import Box, Heightfield, Plane, World

Floats = NDArray[np.float32]

PLANE_EXTENT = 60.0  # m, beyond it haze has swallowed the ground

VERTEX_FORMAT = ("3f 3f 2f 1f", "position", "normal", "texture_position", "layer")

# Faces of the unit box: axis, sign. The underside is never seen.
_FACES = ((2, 1.0), (0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """Triangles of one or more solids. A vertex is position, normal, texture coordinates and texture layer."""

    vertices: Floats  # (n, 9)
    indices: NDArray[np.uint32]  # (m, 3), counter-clockwise from outside


def static_surface(world: World, layers: dict[str, int]) -> Surface:
    """All planes and boxes; `layers` says which texture belongs to a material."""
    vertices: list[Floats] = []
    indices: list[NDArray[np.uint32]] = []
    count = 0
    solids: tuple[Plane | Box, ...] = (*world.boxes, *world.planes)
    quads = [quad for solid in solids for quad in _quads(solid)]
    visible = _visible(quads, world)
    for corners, normal, texture, material in (quad for quad, shows in zip(quads, visible, strict=True) if shows):
        block = np.empty((4, 9), dtype=np.float32)
        block[:, 0:3], block[:, 3:6], block[:, 6:8] = corners, normal, texture / PERIOD
        block[:, 8] = layers[material]
        vertices.append(block)
        indices.append(np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32) + np.uint32(count))
        count += 4
    return Surface(vertices=np.concatenate(vertices), indices=np.concatenate(indices))


def heightfield_vertices(field: Heightfield, layer: int) -> Floats:
    """One vertex per node, row-major, (nx * ny, 9)."""
    nx, ny = field.z.shape
    x = field.origin[0] + field.cell * np.arange(nx)
    y = field.origin[1] + field.cell * np.arange(ny)
    slope_x, slope_y = np.gradient(field.z, field.cell)
    normal = np.stack([-slope_x, -slope_y, np.ones_like(field.z)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    vertices = np.empty((nx, ny, 9), dtype=np.float32)
    vertices[..., 0], vertices[..., 1], vertices[..., 2] = x[:, None], y[None, :], field.z
    vertices[..., 3:6] = normal
    vertices[..., 6], vertices[..., 7] = x[:, None] / PERIOD, y[None, :] / PERIOD
    vertices[..., 8] = layer
    return vertices.reshape(-1, 9)


def grid_indices(rows: NDArray[np.int64], columns: NDArray[np.int64], width: int) -> NDArray[np.uint32]:
    """Triangles (m, 3) between the nodes rows x columns of a grid `width` nodes wide, split as Bullet splits them."""
    a = rows[:-1, None] * width + columns[None, :-1]
    b = rows[1:, None] * width + columns[None, :-1]
    c = rows[1:, None] * width + columns[None, 1:]
    d = rows[:-1, None] * width + columns[None, 1:]
    triangles = np.stack([np.stack([a, b, d], axis=-1), np.stack([b, c, d], axis=-1)], axis=-2)
    return triangles.reshape(-1, 3).astype(np.uint32)


_Quad = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], str]


def _visible(quads: list[_Quad], world: World) -> NDArray[np.bool_]:
    """False for upright faces that neighbouring ground covers from edge to edge, (quads,)."""
    corners = np.array([quad[0] for quad in quads])  # (n, 4, 3)
    normals = np.array([quad[1] for quad in quads])
    top = corners[:, :, 2].max(axis=1)
    middle, low, high = corners.mean(axis=1), corners.min(axis=1), corners.max(axis=1)
    covered = np.abs(normals[:, 2]) < 1e-9
    for share in np.linspace(0.02, 0.98, 9):
        along = low + share * (high - low)
        outside = np.where(np.abs(normals) > 0.5, middle, along) + 1e-3 * normals
        covered &= world.elevation(outside[:, 0], outside[:, 1]) >= top - 1e-9
    shows: NDArray[np.bool_] = ~covered
    return shows


def _quads(solid: Plane | Box) -> list[_Quad]:
    """Corners (4, 3), normal (3,), texture coordinates (4, 2) in m and material of every face."""
    if isinstance(solid, Plane):
        e = PLANE_EXTENT
        flat = np.array([[-e, -e], [e, -e], [e, e], [-e, e]])
        corners = np.column_stack([flat, np.full(4, solid.height)])
        return [(corners, np.array([0.0, 0.0, 1.0]), flat, solid.material)]
    quads = []
    centre_in_box = solid.rotation.T @ solid.centre
    for axis, sign in _FACES:
        u, v = (axis + 1) % 3, (axis + 2) % 3
        local = np.zeros((4, 3))
        local[:, axis] = sign * solid.half[axis]
        local[:, u] = np.array([-1.0, 1.0, 1.0, -1.0]) * solid.half[u]
        local[:, v] = np.array([-1.0, -1.0, 1.0, 1.0]) * sign * solid.half[v]
        texture = (local + centre_in_box)[:, [u, v]]
        corners = local @ solid.rotation.T + solid.centre
        quads.append((corners, sign * solid.rotation[:, axis], texture, solid.material))
    return quads
