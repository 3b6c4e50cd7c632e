"""The few shapes that figures are made of, as vertices and faces."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def upright(count: int) -> Array:
    """Unturned attitudes (count, 4), w first."""
    return np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))


def prism(sides: int = 6) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Vertices and faces of a prism of width and height 1 about the origin, axis z."""
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = 0.5 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    bottom, top = (np.column_stack([ring, np.full(sides, z)]) for z in (-0.5, 0.5))
    vertices = np.vstack([bottom, top, [[0, 0, -0.5], [0, 0, 0.5]]])
    faces = []
    for k in range(sides):
        n = (k + 1) % sides
        faces += [
            [k, n, sides + n],
            [k, sides + n, sides + k],
            [2 * sides, n, k],
            [2 * sides + 1, sides + k, sides + n],
        ]
    return vertices.astype(np.float32), np.array(faces, dtype=np.uint32)


def octasphere(subdivisions: int = 2) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Vertices and faces of a unit sphere, from an octahedron split into four `subdivisions` times."""
    vertices = [np.array(v, dtype=np.float64) for v in
                ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]  # fmt: skip
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(subdivisions):
        middle: dict[tuple[int, int], int] = {}
        split = []
        for a, b, c in faces:
            ab, bc, ca = (_middle(vertices, middle, p, q) for p, q in ((a, b), (b, c), (c, a)))
            split += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = split
    return np.array(vertices, dtype=np.float32), np.array(faces, dtype=np.uint32)


def _middle(vertices: list[Array], known: dict[tuple[int, int], int], a: int, b: int) -> int:
    edge = (min(a, b), max(a, b))
    if edge not in known:
        known[edge] = len(vertices)
        point = vertices[a] + vertices[b]
        vertices.append(point / np.linalg.norm(point))
    return known[edge]
