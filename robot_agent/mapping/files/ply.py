"""A map's known cells as a coloured point cloud in PLY, binary and little-endian."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from robot_agent.mapping.files.snapshot import MapSnapshot
from weaver_shared.errors import InputError

VERTEX = np.dtype(
    [
        ("x", "<f4"),
        ("y", "<f4"),
        ("z", "<f4"),
        ("red", "u1"),
        ("green", "u1"),
        ("blue", "u1"),
        ("sigma", "<f4"),
        ("roughness", "<f4"),
        ("step_height", "<f4"),
    ]
)
PLY_TYPES = {"f": "float", "u": "uchar"}
CALM, ROUGH, UNKNOWN = np.array([60, 110, 180]), np.array([220, 80, 30]), np.array([150, 150, 150])


def write_ply(path: Path, snapshot: MapSnapshot) -> int:
    """Write a vertex for each known cell, coloured from calm (blue) to rough (orange); returns their number."""
    elevation = snapshot.layers["elevation"]
    rows, columns = np.nonzero(np.isfinite(elevation))
    vertices = np.zeros(len(rows), dtype=VERTEX)
    vertices["x"] = (snapshot.row0 + rows + 0.5) * snapshot.cell
    vertices["y"] = (snapshot.column0 + columns + 0.5) * snapshot.cell
    vertices["z"] = elevation[rows, columns]
    vertices["sigma"] = np.sqrt(snapshot.layers["variance"][rows, columns])
    vertices["roughness"] = snapshot.layers["roughness"][rows, columns]
    vertices["step_height"] = snapshot.layers["step_height"][rows, columns]
    rough = vertices["roughness"][:, None]
    colour = np.where(np.isfinite(rough), CALM + (ROUGH - CALM) * np.nan_to_num(rough), UNKNOWN)
    for index, name in enumerate(("red", "green", "blue")):
        vertices[name] = np.rint(colour[:, index])
    properties = "".join(f"property {PLY_TYPES[VERTEX[name].kind]} {name}\n" for name in VERTEX.names or ())
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{properties}end_header\n"
    try:
        path.write_bytes(head.encode() + vertices.tobytes())
    except OSError as error:
        raise InputError(f"{path} can not be written: {error.strerror}") from error
    return len(vertices)
