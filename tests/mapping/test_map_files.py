"""A saved map comes back as it was; others can read what is exported; damaged files are answered in a sentence."""

import json

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from made_ground import at, seen
from PIL import Image

from robot_agent.command_line import map as map_command
from robot_agent.mapping import TerrainMap
from robot_agent.mapping.files import LAYERS, load_map, save_map, write_costmap, write_geotiff, write_ply
from robot_agent.mapping.files.ply import VERTEX
from weaver_shared.config.mapping import MappingConfig
from weaver_shared.errors import InputError


def bumpy(x, y):
    return 0.1 * x + 0.04 * np.sign(np.sin(31.4 * x)) * np.sign(np.sin(31.4 * y))


@pytest.fixture(scope="module")
def walked():
    terrain_map = TerrainMap()
    terrain_map.update(seen(bumpy, x=(-0.3, 1.2), y=(-0.9, 0.4), stamp_ns=7_000_000_000), at())
    terrain_map.touch(np.array([[0.2, 0.1, 0.03], [1.5, 0.9, 0.2]]), 8_000_000_000)
    return terrain_map


@pytest.fixture
def saved(walked, tmp_path):
    save_map(tmp_path / "map.npz", walked.snapshot())
    return tmp_path / "map.npz"


def test_a_map_comes_back_layer_by_layer(walked, saved):
    restored = TerrainMap()
    restored.restore(load_map(saved))
    for x in np.arange(-0.29, 1.2, 0.11):
        for y in np.arange(-0.89, 0.4, 0.13):
            assert restored.elevation_at(x, y) == walked.elevation_at(x, y)
    assert restored.elevation_at(1.5, 0.9) == pytest.approx(0.2)
    found, expected = (m.worst_within(0.5, -0.2) for m in (restored, walked))
    assert found.roughness == pytest.approx(expected.roughness, abs=1e-4)
    assert restored.changed_tiles(9_000_000_000)


@given(st.floats(-20.0, 20.0), st.floats(-20.0, 20.0))
def test_a_map_is_restored_wherever_it_lies(x, y):
    terrain_map = TerrainMap(MappingConfig(tile=8, tiles=5))
    terrain_map.update(seen(bumpy, x=(x - 0.2, x + 0.2), y=(y - 0.1, y + 0.1)), at(x, y))
    restored = TerrainMap(MappingConfig(tile=8, tiles=5))
    restored.restore(terrain_map.snapshot())
    for name in LAYERS:
        np.testing.assert_allclose(
            np.sort(getattr(restored.grid, name), axis=None),
            np.sort(getattr(terrain_map.grid, name), axis=None),
            1e-3,
            1e-3,
        )
    assert restored.elevation_at(x, y) == terrain_map.elevation_at(x, y)


def test_an_empty_map_is_a_map(tmp_path):
    save_map(tmp_path / "empty.npz", TerrainMap().snapshot())
    assert np.isnan(load_map(tmp_path / "empty.npz").layers["elevation"]).all()


def test_the_geotiff_is_read_by_others_with_its_place(walked, tmp_path):
    snapshot = walked.snapshot()
    write_geotiff(tmp_path / "map.tif", snapshot)
    picture = cv2.imread(str(tmp_path / "map.tif"), cv2.IMREAD_UNCHANGED)
    assert picture.dtype == np.float32
    np.testing.assert_array_equal(picture, snapshot.layers["elevation"].T[::-1])
    with Image.open(tmp_path / "map.tif") as image:
        tags = image.tag_v2
        scale, tie = tags[33550], tags[33922]
        assert scale[0] == scale[1] == snapshot.cell
        assert tags[42113] == "nan"
        assert tags[34735][:4] == (1, 1, 0, 4)
    row, column = 11, 17
    x, y = tie[3] + (column + 0.5) * scale[0], tie[4] - (row + 0.5) * scale[1]
    np.testing.assert_equal(float(picture[row, column]), walked.elevation_at(x, y))


def test_the_point_cloud_holds_every_known_cell(walked, tmp_path):
    snapshot = walked.snapshot()
    number = write_ply(tmp_path / "map.ply", snapshot)
    head, _, body = (tmp_path / "map.ply").read_bytes().partition(b"end_header\n")
    vertices = np.frombuffer(body, dtype=VERTEX)
    assert f"element vertex {number}\n".encode() in head
    assert len(vertices) == number == np.isfinite(snapshot.layers["elevation"]).sum()
    for vertex in vertices[::97]:
        assert walked.elevation_at(vertex["x"], vertex["y"]) == pytest.approx(vertex["z"])


def test_the_costmap_is_white_where_flat_black_where_rough_and_grey_where_unknown(walked, tmp_path):
    snapshot = walked.snapshot()
    description = yaml.safe_load(write_costmap(tmp_path / "map.png", snapshot).read_text())
    picture = cv2.imread(str(tmp_path / description["image"]), cv2.IMREAD_UNCHANGED)
    assert description["resolution"] == snapshot.cell
    assert description["origin"] == [*snapshot.corner, 0.0]
    x, y = 0.5, -0.2
    column = int((x - description["origin"][0]) / description["resolution"])
    row = picture.shape[0] - 1 - int((y - description["origin"][1]) / description["resolution"])
    assert picture[row, column] < 30
    known = np.isfinite(snapshot.layers["roughness"]) & np.isfinite(snapshot.layers["elevation"])
    assert (picture != 205).sum() == known.sum()
    flat = TerrainMap()
    flat.update(seen(lambda px, py: 0.0 * px), at())
    write_costmap(tmp_path / "flat.png", flat.snapshot())
    grey = cv2.imread(str(tmp_path / "flat.png"), cv2.IMREAD_UNCHANGED)
    assert grey[grey != 205].min() > 240


def test_the_command_tells_what_a_map_holds_and_converts_it(saved, tmp_path, capsys):
    outputs = [str(tmp_path / name) for name in ("a.ply", "a.tif", "a.png")]
    options = ["--ply", outputs[0], "--geotiff", outputs[1], "--layer", "roughness", "--costmap", outputs[2]]
    assert map_command.main([str(saved), *options, "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["layers"]["contact"]["cells"] >= 2
    assert facts["layers"]["ceiling"]["cells"] == 0
    assert set(outputs) < set(facts["written"])
    assert map_command.main([str(saved)]) == 0
    assert "roughness" in capsys.readouterr().out


def changed(path, **changes):
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    for name, value in changes.items():
        layer = name in LAYERS or name == "seen_ns"
        fill = layer and value is not None and np.ndim(value) == 0
        arrays[name] = np.full(arrays["seen_ns"].shape, value) if fill else value
    arrays = {name: array for name, array in arrays.items() if array is not None}
    np.savez(path, **arrays)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"version": 2}, "a map of version 2; this program reads version 1"),
        ({"kind": "something"}, "is not a map"),
        ({"roughness": None}, "a map without roughness"),
        ({"slope": np.zeros((3, 3))}, "different shapes"),
        ({"resolution": 0.0}, "must be positive"),
        ({"version": "new"}, "a map of version new"),
        ({"version": 1.5}, "a map of version 1.5"),
        ({"resolution": [0.02, 0.02]}, "resolution has to be one number"),
        ({"resolution": "fine"}, "resolution has to be one number"),
        ({"row0": np.nan}, "row0 has to be one number"),
        ({"row0": 0.5}, "no whole number of cells"),
        ({"column0": 10**18}, "no whole number of cells"),
        ({"elevation": "high"}, "elevation has to be numbers"),
        ({"elevation": np.inf}, "elevation holds inf"),
        ({"variance": -1.0}, "variance holds -1.0, and can not be negative"),
        ({"seen_ns": np.nan}, "whole nanoseconds"),
        (dict.fromkeys((*LAYERS, "seen_ns"), ()), "different shapes|at least one cell"),
    ],
)
def test_other_versions_and_broken_maps_are_refused_in_a_sentence(saved, changes, sentence):
    changed(saved, **changes)
    with pytest.raises(InputError, match=sentence):
        load_map(saved)


def test_a_map_cut_off_or_with_a_wrong_bit_is_refused_or_whole(saved):
    """Some bits say nothing, such as a member's date; all that do are guarded by the archive."""
    whole, data = load_map(saved), saved.read_bytes()
    for end in range(0, len(data), len(data) // 20):
        saved.write_bytes(data[:end])
        with pytest.raises(InputError, match=r"can not be read|is not a map"):
            load_map(saved)
    generator = np.random.default_rng(0)
    for place in generator.integers(0, len(data), 200):
        broken = bytearray(data)
        broken[place] ^= 1 << int(generator.integers(8))
        saved.write_bytes(broken)
        try:
            found = load_map(saved)
        except InputError:
            continue
        np.testing.assert_array_equal(found.layers["elevation"], whole.layers["elevation"])


def test_files_that_are_no_maps_are_refused_in_a_sentence(tmp_path, walked):
    (tmp_path / "bad.npz").write_bytes(b"PK\x03\x04 not really")
    with pytest.raises(InputError, match="can not be read"):
        load_map(tmp_path / "bad.npz")
    with pytest.raises(InputError, match="not a file"):
        load_map(tmp_path / "none.npz")
    with pytest.raises(InputError, match="can not be written"):
        save_map(tmp_path / "no" / "map.npz", walked.snapshot())
    with pytest.raises(InputError, match=r"a costmap is a \.png"):
        write_costmap(tmp_path / "map.pgm", walked.snapshot())
    with pytest.raises(InputError, match=r"no layer 'colour'"):
        write_geotiff(tmp_path / "map.tif", walked.snapshot(), "colour")


def test_cells_of_another_size_are_refused(walked):
    with pytest.raises(ValueError, match=r"0\.05"):
        TerrainMap(MappingConfig(cell=0.05)).restore(walked.snapshot())
