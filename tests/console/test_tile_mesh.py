"""Map tiles as binary glTF."""

import hashlib
import io
import json
import struct

import numpy as np
import pytest
import trimesh
from wire_robot import ground_height, ground_tile

from weaver_console.scene.ground import UNKNOWN_MM, Ground
from weaver_console.scene.layers import LAYERS, layer_values, legend
from weaver_console.scene.terrain_figure import MeshStore
from weaver_console.scene.tile_mesh import LINEAR, height_field_glb, tile_mesh

SCALE = legend("elevation", (-0.05, 0.12))


def _ground(*places: tuple[int, int]) -> Ground:
    ground = Ground()
    for place in places:
        ground.put(ground_tile(*place))
    return ground


def _mesh(glb: bytes) -> trimesh.Trimesh:
    scene = trimesh.load(io.BytesIO(glb), file_type="glb", process=False)
    (mesh,) = scene.dump()
    return mesh


def _attribute(glb: bytes, view: int, dtype: type) -> np.ndarray:
    length = struct.unpack("<I", glb[12:16])[0]
    place = json.loads(glb[20 : 20 + length])["bufferViews"][view]
    start = 28 + length + place["byteOffset"]
    return np.frombuffer(glb[start : start + place["byteLength"]], dtype)


def test_a_small_height_field_has_these_very_bytes():
    elevation = np.array([[0, 10], [20, -30]], dtype=np.int16)
    colours = np.array([[[0, 128, 255], [255, 0, 0]], [[1, 2, 3], [9, 9, 9]]], dtype=np.uint8)
    faces = np.array([[0, 2, 3], [0, 3, 1]], dtype=np.uint16)
    opaque = np.dstack([LINEAR[colours], np.full((2, 2), 255, dtype=np.uint8)])
    glb = height_field_glb(elevation, opaque, faces, origin=(1.5, -2.0), cell=0.02)
    assert glb[:4] == b"glTF"
    assert struct.unpack("<I", glb[8:12])[0] == len(glb)
    assert len(glb) % 4 == 0
    head = json.loads(glb[20 : 20 + struct.unpack("<I", glb[12:16])[0]])
    assert head["nodes"][0]["translation"] == [1.5, -2.0, 0.0]
    assert head["accessors"][0]["min"] == [0, 0, -30]
    binary = glb[-60:]
    assert np.array_equal(np.frombuffer(binary[:32], "<i2").reshape(4, 4)[:, 2], [0, 10, 20, -30])
    assert hashlib.sha256(glb).hexdigest()[:16] == GOLDEN


GOLDEN = "5724bc3a3b3b9a00"


def test_a_reader_of_gltf_finds_every_cell_in_its_place():
    mesh = _mesh(tile_mesh(_ground((0, 0), (1, 0), (0, 1), (1, 1)), (0, 0), SCALE))
    assert mesh.vertices.shape == (33 * 33, 3)
    assert mesh.faces.shape == (2 * 32 * 32, 3)
    x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
    assert x.min() == pytest.approx(0.01) and x.max() == pytest.approx(0.65)  # noqa: PT018
    assert np.allclose(mesh.vertices[:, 2], ground_height(x, y), atol=0.00051)
    assert (mesh.face_normals[:, 2] > 0.0).all()


def test_tiles_join_without_a_gap_and_end_where_nothing_is_known():
    alone = _mesh(tile_mesh(_ground((0, 0)), (0, 0), SCALE))
    joined = _mesh(tile_mesh(_ground((0, 0), (1, 0)), (0, 0), SCALE))
    assert len(alone.faces) == 2 * 31 * 31
    assert len(joined.faces) == 2 * 32 * 31


def test_unknown_cells_have_no_faces():
    ground = _ground((0, 0))
    tile = ground.tiles[0, 0]
    tile.elevation_mm.flags.writeable = True
    tile.elevation_mm[10, 10] = UNKNOWN_MM
    assert len(_mesh(tile_mesh(ground, (0, 0), SCALE)).faces) == 2 * (31 * 31 - 4)
    tile.elevation_mm[:] = UNKNOWN_MM
    assert tile_mesh(ground, (0, 0), SCALE) is None


@pytest.mark.parametrize("layer", LAYERS)
def test_colours_are_those_of_the_legend(layer):
    ground = _ground((0, 0))
    tile = ground.tiles[0, 0]
    tile.sigma_mm[:] = 0
    scale = legend(layer, (-0.05, 0.12))
    glb = tile_mesh(ground, (0, 0), scale)
    wanted = scale.colours(layer_values(tile, layer)).astype(float)
    linear = _attribute(glb, 1, np.uint8).reshape(33, 33, 4)[:32, :32, :3] / 255.0
    shown = 255.0 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(shown - wanted).max() < 14.0  # linear bytes are coarse in the dark
    assert np.abs(shown - wanted).mean() < 2.0


def test_a_full_tile_has_less_than_thirty_bytes_a_cell():
    assert len(tile_mesh(_ground((0, 0), (1, 0), (0, 1), (1, 1)), (0, 0), SCALE)) < 30 * 32 * 32


def test_a_mesh_is_made_once_for_all_pages_and_anew_when_a_neighbour_changes():
    ground, store = _ground((0, 0)), MeshStore()
    first = store.mesh(ground, (0, 0), SCALE)
    assert store.mesh(ground, (0, 0), SCALE) is first
    ground.put(ground_tile(1, 0))
    assert store.mesh(ground, (0, 0), SCALE) != first
