"""`weaver terrain`: tables are level, boxes and stairs have their heights, bad files are answered in a sentence."""

import json
from pathlib import Path

import numpy as np
import pytest

from robot_agent.command_line import terrain
from weaver_shared.errors import InputError
from weaver_shared.transforms import rotation_from_rpy

DATA = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "terrain"


def report(path, capsys, *options):
    assert terrain.main([str(path), "--json", *options]) == 0
    return json.loads(capsys.readouterr().out)


def recorded(name):
    path = DATA / f"{name}.npz"
    if not path.is_file():
        pytest.skip(f"the recording {path.name} is not on this machine")
    return path


def camera_cloud(boxes, *, pitch=0.65, roll=0.05, noise=0.0015, seed=0, height=0.9):
    """Points a camera `height` m over a level table sees of it and of boxes (x, y, half width, top), optical frame."""
    rng = np.random.default_rng(seed)
    v, u = np.mgrid[0:240, 0:320]
    rays = np.stack([(u - 160) / 260.0, (v - 120) / 260.0, np.ones_like(u, dtype=float)], axis=-1).reshape(-1, 3)
    level_from_forward = rotation_from_rpy(roll, pitch, 0.0)
    level_from_optical = level_from_forward @ np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    directions = rays @ level_from_optical.T
    falling = np.minimum(directions[:, 2], -1e-3)
    depth = np.where(directions[:, 2] < -0.1, -height / falling, np.inf)
    for x, y, half, top in boxes:
        reach = (top - height) / falling
        inside = np.abs(reach[:, None] * directions[:, :2] - [x, y]).max(axis=1) < half
        depth = np.where(inside, np.minimum(depth, reach), depth)
    depth[depth > 2.0] = np.nan
    cloud = rays * (depth + noise * rng.normal(size=depth.shape))[:, None]
    return cloud, level_from_optical.T @ [0.0, 0.0, 1.0]


BOXES = ((1.05, 0.0, 0.12, 0.11), (1.0, -0.32, 0.1, 0.06))


@pytest.fixture
def table(tmp_path):
    cloud, up = camera_cloud(BOXES)
    path = tmp_path / "table.npz"
    np.savez(path, xyz=cloud.reshape(240, 320, 3), table_normal=-up)
    return path


def test_the_plane_is_the_table_and_the_steps_are_the_boxes(table, capsys):
    found = report(table, capsys)
    assert found["plane"]["tilt_deg"] < 0.3
    assert found["plane"]["tilt_reference"] == "labelled up"
    assert found["plane"]["normal_in_input"][1] < 0.0  # towards the camera
    assert found["steps"] == pytest.approx([0.06, 0.11], abs=0.005)


def test_the_label_does_not_enter_the_plane(table, tmp_path, capsys):
    with np.load(table) as archive:
        np.savez(tmp_path / "wrong.npz", xyz=archive["xyz"], table_normal=[1.0, 0.0, 0.0])
        np.savez(tmp_path / "none.npz", xyz=archive["xyz"].reshape(-1, 3))
    wrong, none = (report(tmp_path / f"{name}.npz", capsys)["plane"] for name in ("wrong", "none"))
    assert wrong["normal_in_input"] == none["normal_in_input"]
    assert wrong["tilt_deg"] > 45.0
    assert none["tilt_reference"] == "camera up (-y)"


def test_a_camera_looking_straight_down_sees_the_table_too(tmp_path, capsys):
    cloud, up = camera_cloud(((0.0, 0.1, 0.15, 0.08),), pitch=np.pi / 2, roll=0.0)
    np.savez(tmp_path / "down.npz", xyz=cloud, table_normal=up)
    found = report(tmp_path / "down.npz", capsys)
    assert found["plane"]["tilt_deg"] < 0.3
    assert found["plane"]["normal_in_input"][2] < -0.99
    assert found["steps"] == pytest.approx([0.08], abs=0.005)


def test_paper_mode_is_thrown_by_the_boxes(table, capsys):
    assert report(table, capsys, "--mode", "paper")["plane"]["tilt_deg"] > report(table, capsys)["plane"]["tilt_deg"]


def test_scale_turns_millimetres_into_metres(table, tmp_path, capsys):
    with np.load(table) as archive:
        np.savez(tmp_path / "mm.npz", points=1000.0 * archive["xyz"])
    assert report(tmp_path / "mm.npz", capsys, "--scale", "0.001")["steps"] == pytest.approx([0.06, 0.11], abs=0.005)


def test_stairs_in_a_grid_with_zeros_for_unknown(tmp_path, capsys):
    heights = np.repeat(0.18 * np.arange(5) + 0.2, 8)[:, None] + np.zeros((40, 30))
    heights = np.round((heights + 0.002 * np.random.default_rng(0).normal(size=heights.shape)) / 0.005) * 0.005
    heights[:, :4] = 0.0
    np.savez(tmp_path / "stairs.npz", elevation=heights.astype(np.float32), resolution=0.04)
    found = report(tmp_path / "stairs.npz", capsys)
    assert np.diff([0.0, *found["steps"]]) == pytest.approx(0.18, abs=0.008)
    assert found["step_height"]["value"] > 0.98


@pytest.mark.parametrize(
    ("name", "steps"), [("mosd_learn19", [0.059, 0.108]), ("mosd_learn0", [0.209, 0.248]), ("table_stereo", None)]
)
def test_recorded_tables_are_level_within_half_a_degree(name, steps, capsys):
    found = report(recorded(name), capsys)
    assert found["plane"]["tilt_deg"] < 0.5
    assert found["plane"]["rms"] < 0.003
    if steps:
        assert found["steps"] == pytest.approx(steps, abs=0.005)


def test_recorded_stairs_rise_as_measured(capsys):
    found = report(recorded("anymal_stairs"), capsys)
    rises = np.diff([step for step in found["steps"] if step > 0.15 and abs(step - 0.265) > 0.02])
    assert rises == pytest.approx([0.19] * 3, abs=0.01)
    assert 0.18 <= found["stairs"]["rise"] <= 0.19
    assert found["stairs"]["rises"] == 4


def test_recorded_map_has_its_four_platforms(capsys):
    found = report(recorded("eth_traversability_map"), capsys)
    assert found["steps"] == pytest.approx([0.1, 0.2, 0.3, 0.4], abs=0.005)


def test_slope_and_roughness_equal_the_layers_that_eths_filters_computed(capsys):
    compared = report(recorded("eth_traversability_map"), capsys)["layers"]["compared_with_file"]
    slope, roughness = compared["traversability_slope"], compared["traversability_roughness"]
    assert slope["cells"] > 12_000
    assert slope["p99_difference"] < 2e-6  # rad
    assert roughness["cells"] > 13_000
    assert roughness["p99_difference"] < 1e-8  # m


@pytest.mark.parametrize(
    ("arrays", "sentence"),
    [
        ({"colour": np.zeros((4, 4))}, "expected a cloud"),
        ({"xyz": np.full((500, 3), np.nan)}, "0 valid points"),
        ({"xyz": np.random.default_rng(0).normal(size=(900, 3))}, "no plane"),
        ({"elevation": np.zeros((40, 40))}, "cell length"),
        ({"elevation": np.full((40, 40), np.nan), "resolution": 0.02}, "0 known cells"),
        ({"elevation": np.zeros((0, 0)), "resolution": 0.02}, "0 known cells"),
        ({"elevation": np.zeros((1, 500)), "resolution": 0.02}, "span no plane"),
        ({"elevation": np.zeros((40, 40)), "resolution": np.inf}, "cell length"),
        ({"elevation": np.zeros((40, 40)), "resolution": "fine"}, "cell length"),
        ({"elevation": np.full((40, 40), "high"), "resolution": 0.02}, "elevation has to be numbers"),
        ({"xyz": np.full((500, 3), "far")}, "xyz has to be numbers"),
        ({"xyz": np.zeros((0, 3))}, "0 valid points"),
        ({"xyz": np.ones((500, 3))}, "no plane"),
    ],
)
def test_unusable_arrays_are_answered_in_a_sentence(tmp_path, arrays, sentence):
    np.savez(tmp_path / "bad.npz", **arrays)
    with pytest.raises(InputError, match=sentence):
        terrain.main([str(tmp_path / "bad.npz"), "--json"])


@pytest.mark.parametrize("laid_out", ["picture", "list with its width", "list"])
def test_points_behind_the_camera_are_no_ground(tmp_path, laid_out):
    cloud, up = camera_cloud(BOXES)
    arrays = {"xyz": -cloud, "table_normal": up}
    if laid_out == "picture":
        arrays["xyz"] = -cloud.reshape(240, 320, 3)
    elif laid_out == "list with its width":
        arrays |= {"height": 240, "width": 320}
    np.savez(tmp_path / "behind.npz", **arrays)
    with pytest.raises(InputError, match="behind the camera"):
        terrain.main([str(tmp_path / "behind.npz"), "--json"])


def test_a_cloud_in_a_frame_of_the_world_may_lie_anywhere(tmp_path, capsys):
    """High above its origin it does not pass for a camera's, nor is its plane taken for a thick one."""
    cloud, up = camera_cloud(BOXES)
    across = np.cross([0.0, 0.0, 1.0], up) / np.linalg.norm(np.cross([0.0, 0.0, 1.0], up))
    level_from_optical = np.stack([across, np.cross(up, across), up])
    for origin in ([0.0, 0.0, 0.0], [5.0, -3.0, 100.0], [-4000.0, 70.0, -300.0]):
        np.savez(tmp_path / "world.npz", points=cloud @ level_from_optical.T + origin)
        found = report(tmp_path / "world.npz", capsys)
        assert found["frame"] == "z up"
        assert found["plane"]["tilt_deg"] < 0.3
        assert found["steps"] == pytest.approx([0.06, 0.11], abs=0.005)


def test_unknown_borders_and_infinite_cells_change_nothing(tmp_path, capsys):
    heights = np.repeat(0.18 * np.arange(5), 8)[:, None] + 0.002 * np.random.default_rng(0).normal(size=(40, 30))
    framed = np.full((60, 50), np.nan)
    framed[12:52, 7:37] = heights
    framed[:12] = np.inf
    for name, grid in (("bare", heights), ("framed", framed)):
        np.savez(tmp_path / f"{name}.npz", elevation=grid, resolution=0.04)
    bare, framed = (report(tmp_path / f"{name}.npz", capsys) for name in ("bare", "framed"))
    assert framed["steps"] == bare["steps"]
    assert framed["stairs"] == bare["stairs"]
    assert framed["roughness"]["value"] == pytest.approx(bare["roughness"]["value"])


def test_missing_and_damaged_files_are_answered_in_a_sentence(tmp_path):
    (tmp_path / "bad.npz").write_bytes(b"PK\x03\x04 not really")
    with pytest.raises(InputError, match="can not be read"):
        terrain.main([str(tmp_path / "bad.npz")])
    np.save(tmp_path / "bare.npy", np.zeros((4, 3)))
    with pytest.raises(InputError, match="bare array"):
        terrain.main([str(tmp_path / "bare.npy")])
    with pytest.raises(InputError, match="not a file"):
        terrain.main([str(tmp_path / "none.npz")])
    with pytest.raises(InputError, match="positive factor"):
        terrain.main([str(tmp_path / "none.npz"), "--scale", "-1"])


def test_a_grids_layers_are_written_and_those_of_a_cloud_refused(tmp_path, table, capsys):
    x = np.arange(30)[:, None] * 0.02 + np.zeros((30, 20))
    np.savez(tmp_path / "ramp.npz", elevation=0.5 * x, resolution=0.02)
    report(tmp_path / "ramp.npz", capsys, "--layers", str(tmp_path / "layers.npz"))
    with np.load(tmp_path / "layers.npz") as layers:
        assert layers["slope"] == pytest.approx(np.full((30, 20), np.arctan(0.5)), abs=1e-6)
        assert layers["roughness"] == pytest.approx(np.zeros((30, 20)), abs=1e-6)
    with pytest.raises(InputError, match="has no cells of its own"):
        terrain.main([str(table), "--layers", str(tmp_path / "layers.npz")])
