"""One layer of a map as a GeoTIFF: float32, metres of the world frame, north (+y) up as geographers lay it out."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from robot_agent.mapping.files.snapshot import LAYERS, MapSnapshot
from weaver_shared.errors import InputError

SHORT, LONG, DOUBLE, ASCII = 3, 4, 12, 2  # TIFF 6.0 field types
FORMATS = {SHORT: "H", LONG: "I", DOUBLE: "d"}
# GeoTIFF 1.1 keys: a projected system of the user's own, pixels are areas, lengths in metres.
GEO_KEYS = (1, 1, 0, 4, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32767, 3076, 0, 1, 9001)
HEADER = 8


def write_geotiff(path: Path, snapshot: MapSnapshot, layer: str = "elevation") -> None:
    """Raises InputError on a layer the map does not have, or when the file can not be written."""
    if layer not in snapshot.layers:
        raise InputError(f"the map has no layer {layer!r}; its layers are {', '.join(LAYERS)}")
    # Picture rows run from the largest y down, columns along x.
    picture = np.ascontiguousarray(snapshot.layers[layer].T[::-1], dtype="<f4")
    height, width = picture.shape
    west, south = snapshot.corner
    north = south + height * snapshot.cell
    fields: list[tuple[int, int, tuple[float, ...] | bytes]] = [
        (256, LONG, (width,)),
        (257, LONG, (height,)),
        (258, SHORT, (32,)),  # bits a sample
        (259, SHORT, (1,)),  # not compressed
        (262, SHORT, (1,)),  # black is zero
        (273, LONG, (HEADER,)),  # where the one strip begins
        (277, SHORT, (1,)),  # samples a pixel
        (278, LONG, (height,)),  # rows of the strip
        (279, LONG, (picture.nbytes,)),
        (339, SHORT, (3,)),  # floating point
        (33550, DOUBLE, (snapshot.cell, snapshot.cell, 0.0)),  # metres a pixel
        (33922, DOUBLE, (0.0, 0.0, 0.0, west, north, 0.0)),  # the first pixel's corner
        (34735, SHORT, GEO_KEYS),
        (42113, ASCII, b"nan\0"),  # GDAL's value for unknown
    ]
    directory = HEADER + picture.nbytes
    try:
        path.write_bytes(
            b"II*\0" + struct.pack("<I", directory) + picture.tobytes() + _directory(fields, begin=directory)
        )
    except OSError as error:
        raise InputError(f"{path} can not be written: {error.strerror}") from error


def _directory(fields: list[tuple[int, int, tuple[float, ...] | bytes]], begin: int) -> bytes:
    """The image file directory that lies at offset `begin`, followed by the values that do not fit into it."""
    entries, values = struct.pack("<H", len(fields)), b""
    after = begin + 2 + 12 * len(fields) + 4
    for tag, kind, value in fields:
        packed = value if isinstance(value, bytes) else struct.pack(f"<{len(value)}{FORMATS[kind]}", *value)
        entries += struct.pack("<HHI", tag, kind, len(value))
        if len(packed) <= 4:
            entries += packed.ljust(4, b"\0")
        else:
            entries += struct.pack("<I", after + len(values))
            values += packed + b"\0" * (len(packed) % 2)
    return entries + struct.pack("<I", 0) + values
