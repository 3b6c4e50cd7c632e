"""A map tile as binary glTF: a height field in whole millimetres with a colour at every cell, some 20 bytes a cell.

Written by hand because meshes that a library builds take ten times the time and twice the bytes; the quantised
attributes are the extension KHR_mesh_quantization. There are no normals: viser computes its own, and wrongly where
quantised ones are given.
"""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.ground import UNKNOWN_MM, Ground, TileIndex
from weaver_console.scene.layers import Legend, layer_field, layer_values
from weaver_shared.messages import MapTile

SIGMA_SHOWN_MM = 60.0
"""Standard deviation at which a cell has lost half of its colour to grey."""

UNKNOWN_SIGMA = 255
_UNKNOWN = {"elevation_mm": UNKNOWN_MM, "sigma_mm": UNKNOWN_SIGMA, "roughness": 255, "step_height": 255, "age_s": 255}

_GREY = np.array([128.0, 132.0, 138.0])
_SRGB = np.arange(256) / 255.0
LINEAR = np.rint(255.0 * np.where(_SRGB <= 0.04045, _SRGB / 12.92, ((_SRGB + 0.055) / 1.055) ** 2.4)).astype(np.uint8)
"""glTF wants vertex colours linear."""


def tile_mesh(ground: Ground, index: TileIndex, legend: Legend) -> bytes | None:
    """GLB of one tile in world coordinates, joined to the neighbours in +x and +y; None if nothing in it is known."""
    tile = ground.tiles[index]
    joined = _with_neighbours(ground, tile, layer_field(legend.layer))
    faces = _faces(joined.elevation_mm != UNKNOWN_MM)
    if not faces.size:
        return None
    origin = ((tile.i * tile.size + 0.5) * tile.cell, (tile.j * tile.size + 0.5) * tile.cell)
    return height_field_glb(joined.elevation_mm, _shaded(joined, legend), faces, origin=origin, cell=tile.cell)


def _with_neighbours(ground: Ground, tile: MapTile, shown: str) -> MapTile:
    """The tile with one row and one column more (size + 1, size + 1), taken from the next tiles, in what is drawn."""
    size = tile.size
    joined: dict[str, Any] = {
        name: np.full((size + 1, size + 1), _UNKNOWN[name], dtype=getattr(tile, name).dtype)
        for name in {"elevation_mm", "sigma_mm", shown}
    }
    for di, dj in ((0, 0), (1, 0), (0, 1), (1, 1)):
        part = ground.tiles.get((tile.i + di, tile.j + dj))
        if part is None or part.size != size or part.cell != tile.cell:
            continue
        to = (slice(size, None) if di else slice(0, size), slice(size, None) if dj else slice(0, size))
        take = (slice(0, 1) if di else slice(None), slice(0, 1) if dj else slice(None))
        for name, layer in joined.items():
            layer[to] = getattr(part, name)[take]
    return replace(tile, size=size + 1, **joined)


def _shaded(tile: MapTile, legend: Legend) -> NDArray[np.uint8]:
    """The layer's colours (r, c, 4) as glTF wants them, greyer where the height is less certain."""
    paint: NDArray[np.uint8] = _paints(legend)[legend.shades(layer_values(tile, legend.layer)), tile.sigma_mm]
    return paint


@lru_cache(maxsize=16)
def _paints(legend: Legend) -> NDArray[np.uint8]:
    """Linear RGBA of every shade of a legend at every standard deviation in mm, (SHADES + 1, 256, 4)."""
    sigma = np.where(np.arange(256) == UNKNOWN_SIGMA, SIGMA_SHOWN_MM, np.arange(256))
    grey = (0.5 * np.minimum(sigma / SIGMA_SHOWN_MM, 1.5))[None, :, None]
    mixed = np.rint(legend.table[:, None, :] * (1.0 - grey) + _GREY * grey).astype(np.uint8)
    paints = np.full((*mixed.shape[:2], 4), 255, dtype=np.uint8)
    paints[..., :3] = LINEAR[mixed]
    return paints


def _faces(known: NDArray[np.bool_]) -> NDArray[np.uint16]:
    """Two triangles, seen from above counter-clockwise, for each square of four known corners, (n, 3)."""
    whole = known[:-1, :-1] & known[1:, :-1] & known[:-1, 1:] & known[1:, 1:]
    pairs = _all_faces(*known.shape)
    if whole.all():
        return pairs.reshape(-1, 3)
    return pairs[:, whole.ravel()].reshape(-1, 3)


@lru_cache(maxsize=8)
def _all_faces(rows: int, columns: int) -> NDArray[np.uint16]:
    """Both triangles of every square of a grid, (2, squares, 3)."""
    number = np.arange(rows * columns, dtype=np.uint16).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    return np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


@lru_cache(maxsize=8)
def _places(rows: int, columns: int, cell_mm: int) -> NDArray[np.int16]:
    """Places of a grid's cells in mm, (rows, columns, 4), at height 0; the fourth pads to 8 bytes as glTF demands."""
    places = np.zeros((rows, columns, 4), dtype="<i2")
    places[..., 0] = np.arange(rows)[:, None] * cell_mm
    places[..., 1] = np.arange(columns)[None, :] * cell_mm
    return places


def height_field_glb(
    elevation_mm: NDArray[np.int16],
    colours: NDArray[np.uint8],
    faces: NDArray[np.uint16],
    *,
    origin: tuple[float, float],
    cell: float,
) -> bytes:
    """Binary glTF of a grid (r, c) of heights in linear RGBA (r, c, 4); its node puts the first cell at `origin` in
    metres, z up."""
    rows, columns = elevation_mm.shape
    cell_mm = round(cell * 1000)
    positions = _places(rows, columns, cell_mm).copy()
    positions[..., 2] = np.where(elevation_mm == UNKNOWN_MM, 0, elevation_mm)
    chunks = [positions.tobytes(), colours.tobytes(), faces.astype("<u2", copy=False).tobytes()]
    scale = cell / (cell_mm * 1e-3) * 1e-3  # exact spacing when the cell is no whole number of millimetres
    heads = _heads(positions[..., :3].reshape(-1, 3), rows * columns, faces.size, chunks)
    node = {"mesh": 0, "scale": [scale, scale, 1e-3], "translation": [origin[0], origin[1], 0.0]}
    return _container({**heads, "nodes": [node]}, b"".join(chunk + b"\0" * (-len(chunk) % 4) for chunk in chunks))


def _heads(positions: NDArray[np.int16], vertices: int, indices: int, chunks: list[bytes]) -> dict[str, object]:
    views, offset = [], 0
    for chunk, (stride, target) in zip(chunks, ((8, 34962), (4, 34962), (0, 34963)), strict=True):
        view = {"buffer": 0, "byteOffset": offset, "byteLength": len(chunk), "target": target}
        views.append({**view, "byteStride": stride} if stride else view)
        offset += len(chunk) + -len(chunk) % 4
    heights = positions[:, 2]
    low, high = [0, 0, int(heights.min())], [*positions[-1, :2].tolist(), int(heights.max())]
    accessors = [
        {"bufferView": 0, "componentType": 5122, "count": vertices, "type": "VEC3", "min": low, "max": high},
        {"bufferView": 1, "componentType": 5121, "normalized": True, "count": vertices, "type": "VEC4"},
        {"bufferView": 2, "componentType": 5123, "count": indices, "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0}
    return {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_mesh_quantization"],
        "extensionsRequired": ["KHR_mesh_quantization"],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "meshes": [{"primitives": [primitive]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0}, "doubleSided": True}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": offset}],
    }


def _container(document: dict[str, object], binary: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    head = struct.pack("<4sII", b"glTF", 2, total)
    return head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
