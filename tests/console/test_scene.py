"""The 3-D view: drawn for one page, clicked by one page, reached only through the console."""

from __future__ import annotations

import asyncio
import dataclasses
import io
import re
from collections.abc import Iterator
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from running_console import Console, Field, Page
from websockets.exceptions import InvalidStatus
from wire_robot import STANDING, ground_height

from weaver_console.png import png
from weaver_console.scene.area_figure import RAILS
from weaver_console.scene.contours import INTERVAL, contours
from weaver_console.scene.contours import LIFT as CONTOUR_LIFT
from weaver_console.scene.ground import UNKNOWN_MM
from weaver_console.scene.layers import TRANSPORT
from weaver_console.scene.mission_figure import LIFT, TOP
from weaver_console.scene.page_scene import THRIFTY_PERIOD, THRIFTY_TILES, PageScene
from weaver_console.scene.posture import Postures, closed_hull, segments, turn_z_to
from weaver_console.scene.shapes import octasphere, prism
from weaver_console.scene.terrain_figure import READING_PICTURES, SEAM_PERIOD, TILES_AN_UPDATE, MeshStore
from weaver_console.scene_page import scene_page
from weaver_shared import topics
from weaver_shared.messages import CameraPicture, PowerState, TruthState, Waypoint
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.transforms import rotation_from_wxyz


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class View:
    scene: PageScene
    picks: list[Any]
    legends: list[Any]
    drags: list[Any]

    def node(self, name: str) -> Any:
        return self.scene._server.scene._handle_from_node_name[name]

    def names(self, beginning: str) -> set[str]:
        return {name for name in self.scene._server.scene._handle_from_node_name if name.startswith(beginning)}

    def tiles(self) -> dict[tuple[int, int], bytes]:
        """The newest mesh of each tile; an older one may be in sight until it has been read."""
        nodes = [tuple(map(int, name.rpartition("/")[2].split("_"))) for name in self.names("/world/terrain/")]
        return {(i, j): self.node(f"/world/terrain/{i}_{j}_{number}").glb_data for i, j, number in sorted(nodes)}


@pytest.fixture
def view() -> Iterator[View]:
    picks: list[Any] = []
    legends: list[Any] = []
    drags: list[Any] = []
    scene = PageScene(
        MeshStore(),
        on_pick=picks.append,
        on_drag=lambda index, place, done: drags.append((index, place, done)),
        on_legend=legends.append,
    )
    yield View(scene=scene, picks=picks, legends=legends, drags=drags)
    scene.close()


def _ray(origin: tuple[float, float, float], target: np.ndarray) -> SimpleNamespace:
    direction = target - np.array(origin)
    return SimpleNamespace(ray_origin=origin, ray_direction=tuple(direction / np.linalg.norm(direction)))


def test_the_robot_stands_where_its_state_says(field: Field, view: View):
    robot = field.robot()
    field.forward(robot, 0.1)
    view.scene.update(field.link.robot("weaver"))
    assert np.allclose(view.node("/world/robot").position, robot.state(0).position_in_world)
    frames = joint_frames_in_body(load_robot("weaver"), STANDING)
    assert np.allclose(view.node("/world/robot/feet").batched_positions, frames[:, -1, :3, 3], atol=1e-6)
    colours = view.node("/world/robot/feet").batched_colors
    assert (colours[:, 1] > colours[:, 0]).all()


def test_the_truth_is_the_robots_own_figure_seen_through(field: Field, view: View):
    robot = field.robot()
    field.forward(robot, 0.1)
    record = field.link.robot("weaver")
    view.scene.wish(truth=True)
    view.scene.update(record)
    ghost = view.node("/world/truth")
    assert ghost.visible
    assert np.allclose(ghost.position, record.newest("truth/state", TruthState).position_in_world)
    links, own = (view.node(f"/world/{name}/links") for name in ("truth", "robot"))
    np.testing.assert_array_equal(links.batched_positions, own.batched_positions)
    assert 0.1 < links.opacity < 0.6
    view.scene.wish(truth=False)
    view.scene.update(record)
    assert not ghost.visible


def test_a_robot_that_tells_no_truth_has_no_ghost(field: Field, view: View):
    robot = field.robot()
    robot._publish = _all_but_truth(robot)
    field.forward(robot, 0.1)
    view.scene.wish(truth=True)
    view.scene.update(field.link.robot("weaver"))
    assert view.node("/world/robot").visible
    assert not view.node("/world/truth").visible


def _all_but_truth(robot: Any) -> Any:
    publish = robot._publish
    return lambda topic, message: None if topic is topics.TRUTH else publish(topic, message)


def _mapped(field: Field, tiles: int) -> Any:
    """The record of a robot that has told a map of `tiles` to each side."""
    robot = field.robot()
    robot.publish_map(tiles)
    field.forward(robot, 0.1)
    return field.link.robot("weaver")


def test_a_forbidden_area_has_a_fence_on_the_ground_until_it_is_gone(field: Field, view: View):
    record = _mapped(field, 3)
    corners = [(1.0, -1.0), (1.8, -1.0), (1.8, -0.2)]
    view.scene.wish(areas=(tuple(Waypoint(x=x, y=y) for x, y in corners),))
    view.scene.update(record)
    fence = view.node("/world/areas/fences")
    assert fence.visible
    points = fence.points.reshape(-1, 3)
    for x, y in corners:
        heights = points[np.hypot(points[:, 0] - x, points[:, 1] - y) < 1e-3, 2]
        ground = float(ground_height(np.array([x]), np.array([y]))[0])
        assert np.unique((heights - ground).round(2)) == pytest.approx([rail + LIFT for rail in RAILS], abs=0.02)
    assert points[:, 2].max() > 0.10 + RAILS[-1]  # over the box that the border crosses
    drawn = fence.points
    view.scene.update(record)
    assert fence.points is drawn  # nothing is sent anew while nothing changes
    view.scene.wish(areas=())
    view.scene.update(record)
    assert not fence.visible


def test_a_whole_map_is_drawn_in_parts_and_then_left_alone(field: Field, view: View):
    record = _mapped(field, 3)
    view.scene.update(record)
    assert len(view.tiles()) == TILES_AN_UPDATE
    view.scene.update(record)
    view.scene.update(record)
    assert len(view.tiles()) == 36
    mesh = view.tiles()[0, 0]
    view.scene.update(record)
    assert view.tiles()[0, 0] is mesh


def test_new_ground_is_drawn_before_the_rest_is_recoloured_and_nothing_waits_for_ever(field: Field, view: View):
    record = _mapped(field, 3)
    for _ in range(3):
        view.scene.update(record)
    before = view.tiles()
    tile = record.ground.tiles[0, 0]
    record.ground.put(dataclasses.replace(tile, i=3, j=0))
    for i, j in list(before):  # all the rest has changed since
        record.ground.put(record.ground.tiles[i, j])
    view.scene.wish(layer="roughness")
    view.scene.thrifty = True
    for _ in range(THRIFTY_PERIOD):
        view.scene.update(record)
    drawn = {index for index, mesh in view.tiles().items() if mesh != before.get(index)}
    assert (3, 0) in drawn
    assert THRIFTY_TILES <= len(drawn) < 36
    for number in range(36 // THRIFTY_TILES * THRIFTY_PERIOD):  # while nine tiles change all the time
        for i in range(3):
            for j in range(3):
                noise = np.int16(number + 1)
                changed = record.ground.tiles[i, j]
                record.ground.put(dataclasses.replace(changed, elevation_mm=changed.elevation_mm + noise))
        view.scene.update(record)
    assert not [index for index, mesh in view.tiles().items() if before.get(index) == mesh]


def test_unknown_tiles_hold_up_nobody(field: Field, view: View):
    record = _mapped(field, 1)
    tile = record.ground.tiles[0, 0]
    unknown = np.full_like(tile.elevation_mm, UNKNOWN_MM)
    for i in range(2, 8):
        for j in range(8):
            record.ground.put(dataclasses.replace(tile, i=i, j=j, elevation_mm=unknown))
    view.scene.update(record)
    assert set(view.tiles()) == {(i, j) for i in (-1, 0) for j in (-1, 0)}


def test_a_changed_tile_is_drawn_at_once_and_its_seams_soon_after(field: Field, view: View):
    record = _mapped(field, 1)
    view.scene.update(record)
    before = view.tiles()
    tile = record.ground.tiles[0, 0]
    record.ground.put(dataclasses.replace(tile, elevation_mm=tile.elevation_mm[::-1]))
    view.scene.update(record)
    assert {index for index, mesh in view.tiles().items() if before[index] != mesh} == {(0, 0)}
    for _ in range(SEAM_PERIOD):
        view.scene.update(record)
    redrawn = {index for index, mesh in view.tiles().items() if before[index] != mesh}
    assert redrawn == {(i, j) for i in (-1, 0) for j in (-1, 0)}


def test_a_tile_stays_in_sight_until_its_successor_has_been_read(field: Field, view: View):
    record = _mapped(field, 1)
    view.scene.update(record)
    for _ in range(READING_PICTURES):
        view.scene.update(record)
    first = view.names("/world/terrain/0_0_")
    age = dict.fromkeys(first, READING_PICTURES)
    tile = record.ground.tiles[0, 0]
    for number in range(1, 4 * READING_PICTURES):  # it changes with every picture
        record.ground.put(dataclasses.replace(tile, elevation_mm=tile.elevation_mm + np.int16(number)))
        view.scene.update(record)
        age = {name: age.get(name, -1) + 1 for name in view.names("/world/terrain/0_0_")}
        assert max(age.values()) >= READING_PICTURES, "nothing is seen of it"
        assert len(age) <= 2
    assert not first & age.keys()
    for _ in range(2 * READING_PICTURES):
        view.scene.update(record)
    assert len(view.names("/world/terrain/0_0_")) == 1


def test_how_a_robot_stands_is_worked_out_once_for_all_pages(field: Field):
    robot = load_robot("weaver")
    postures, state = Postures(), field.robot().state(0)
    assert postures.of(robot, state) is postures.of(robot, state)
    assert postures.of(robot, dataclasses.replace(state, stamp_ns=1)) is not postures.of(robot, state)


def test_another_layer_recolours_every_tile_and_tells_its_legend(field: Field, view: View):
    record = _mapped(field, 1)
    view.scene.update(record)
    before = view.tiles()[0, 0]
    view.scene.wish(layer="roughness")
    view.scene.update(record)
    assert view.tiles()[0, 0] != before
    assert view.legends[-1].layer == "roughness"


def test_a_click_is_answered_with_the_ground_it_hit(field: Field, view: View):
    robot = field.robot()
    robot.publish_map(2)
    field.forward(robot, 0.1)
    view.scene._clicked(_ray((-2.0, 0.0, 2.0), np.array([0.5, 0.1, 0.0])))
    assert view.picks == [None]
    view.scene.update(field.link.robot("weaver"))
    place = np.array([0.5, 0.3, float(ground_height(np.array([0.5]), np.array([0.3]))[0])])
    view.scene._clicked(_ray((-1.0, 0.0, 1.5), place))
    assert np.linalg.norm(view.picks[-1] - place) < 0.02
    view.scene._clicked(_ray((-1.0, 0.0, 1.5), np.array([0.0, 0.0, 5.0])))
    assert view.picks[-1] is None


def test_the_draft_is_drawn_until_the_robot_has_it(field: Field, view: View):
    robot = field.robot()
    field.forward(robot, 0.1)
    record = field.link.robot("weaver")
    draft = (Waypoint(x=1.0, y=0.0), Waypoint(x=1.0, y=1.0))
    view.scene.propose(draft, 1)
    view.scene.update(record)
    assert np.allclose(view.node("/world/mission/draft/balls").batched_positions[:, :2], [[1.0, 0.0], [1.0, 1.0]])
    assert "/world/mission/draft/label 1" in view.names("/world/mission/draft/")
    robot.waypoints = draft
    field.forward(robot, 0.2)
    view.scene.update(record)
    assert not view.names("/world/mission/draft/")
    assert "/world/mission/mission/circles" in view.names("/world/mission/")


def test_a_waypoint_in_hand_stays_the_same_while_its_path_follows(field: Field, view: View):
    record = _mapped(field, 2)
    view.scene.propose([Waypoint(x=0.5, y=0.1), Waypoint(x=0.9, y=0.1)], None)
    view.scene.update(record)
    ball = view.node("/world/mission/draft/balls")
    corridor = np.array(view.node("/world/mission/draft/corridor").points)
    view.scene.propose([Waypoint(x=0.5, y=0.1), Waypoint(x=0.9, y=0.5)], 1)
    view.scene.update(record)
    assert view.node("/world/mission/draft/balls") is ball
    assert ball.batched_positions[1][1] == pytest.approx(0.5)
    assert corridor[..., 1].min() < 0.0
    assert corridor[..., 1].max() > 0.2
    assert not np.array_equal(view.node("/world/mission/draft/corridor").points, corridor)
    view.scene.propose([Waypoint(x=0.5, y=0.1)], None)
    view.scene.update(record)
    assert view.node("/world/mission/draft/balls") is not ball


def test_a_dragged_waypoint_is_told_where_the_hand_points_on_the_ground(field: Field, view: View):
    robot = field.robot()
    robot.publish_map(2)
    field.forward(robot, 0.1)
    view.scene.update(field.link.robot("weaver"))
    eye = (-1.0, 0.0, 1.5)
    client = SimpleNamespace(camera=SimpleNamespace(position=eye))
    for phase, x in (("start", 0.3), ("update", 0.4), ("update", 0.6), ("end", 0.6)):
        place = np.array([x, 0.2, float(ground_height(np.array([x]), np.array([0.2]))[0])]) + TOP
        held = np.array(eye) + 0.7 * (place - np.array(eye))  # somewhere on the line of sight
        event = SimpleNamespace(phase=phase, end_position=tuple(held), instance_index=3, client=client)
        asyncio.run(view.scene._dragged(event))
    assert [(index, round(float(place[0]), 1), done) for index, place, done in view.drags] == [
        (3, 0.4, False),
        (3, 0.6, False),
        (3, 0.6, True),
    ]


def test_what_is_optional_is_drawn_when_it_is_wanted(field: Field, view: View):
    robot = field.robot()
    robot.publish_map(1)
    field.forward(robot, 0.1)
    record = field.link.robot("weaver")
    picture = CameraPicture(stamp_ns=1, name="left", jpeg=b"a jpeg")
    field.bus.publish("weaver", topics.CAMERA, picture, name="left")
    view.scene.wish(frusta=False)
    view.scene.update(record)
    assert not view.names("/world/contours/")
    usual = np.array(view.node("/world/robot/joints").batched_colors)
    view.scene.wish(contours=True, torques=True, frusta=True, measure=(Waypoint(x=0.1, y=0.0), Waypoint(x=0.4, y=0.4)))
    field.forward(robot, 0.02)
    view.scene.update(record)
    lines = np.array(view.node("/world/contours/0_0").points)
    level = (lines[..., 2] - CONTOUR_LIFT) / INTERVAL
    assert np.allclose(level, np.round(level), atol=1e-4)
    assert len({tuple(colour) for colour in view.node("/world/robot/joints").batched_colors}) > 3
    assert view.node("/world/robot/left_eye")._image_data == b"a jpeg"
    assert view.node("/world/measure/label").text.startswith("0.50 m, ")
    view.scene.wish(contours=False, torques=False, measure=())
    field.forward(robot, 0.02)
    view.scene.update(record)
    assert not view.node("/world/contours/0_0").visible
    assert np.array_equal(view.node("/world/robot/joints").batched_colors, usual)
    assert not view.node("/world/measure/label").visible


def test_the_mass_hangs_over_its_margin(field: Field, view: View):
    robot = field.robot()
    field.forward(robot, 0.1)
    view.scene.update(field.link.robot("weaver"))
    mass, edge = view.node("/world/motion/balance/mass"), view.node("/world/motion/balance/margin").points[0]
    assert mass.visible
    assert np.allclose(edge[0][:2], mass.position[:2], atol=1e-6)
    assert view.node("/world/motion/balance/label").text == "0.08 m"


def test_the_trail_tells_what_the_way_cost(field: Field, view: View):
    robot = field.robot()
    field.forward(robot, 0.1)
    record = field.link.robot("weaver")
    for step, cost in enumerate((float("nan"), 2.0, 20.0)):
        robot.place = np.array([0.1 * step, 0.0])
        field.forward(robot, 0.02)
        power = dataclasses.replace(record.newest("tele/power", PowerState), cost_of_transport=cost)
        field.bus.publish("weaver", topics.POWER, power)
        view.scene.update(record)
    colours = np.array(view.node("/world/motion/trail").colors)
    assert np.array_equal(colours[:, 0], TRANSPORT.colours(np.array([2.0, 20.0])))


@given(st.lists(st.floats(-0.2, 0.2), min_size=16, max_size=16))
def test_contours_lie_on_the_ground_at_whole_intervals(heights: list[float]):
    rows, columns = np.indices((4, 4)) * 0.1
    lines = contours(np.stack([rows, columns, np.array(heights).reshape(4, 4)], axis=-1), 0.05)
    assert np.isfinite(lines).all()
    level = (lines[..., 2] - CONTOUR_LIFT) / 0.05
    assert np.allclose(level, np.round(level), atol=1e-6)
    assert (lines[..., :2] >= -1e-9).all()
    assert (lines[..., :2] <= 0.3 + 1e-9).all()


def test_a_hill_has_one_closed_line_a_level():
    rows, columns = np.indices((41, 41)) * 0.05 - 1.0
    lines = contours(np.stack([rows, columns, np.maximum(0.117 - 0.1 * np.hypot(rows, columns), 0.03)], axis=-1), 0.05)
    ends = np.round(lines.reshape(-1, 3), 6)
    _, counts = np.unique(ends, axis=0, return_counts=True)
    assert (counts % 2 == 0).all()  # every end is where another segment begins
    radius = (0.117 - (ends[:, 2] - CONTOUR_LIFT)) / 0.1
    assert np.allclose(np.hypot(ends[:, 0], ends[:, 1]), radius, atol=0.02)


def test_a_picture_is_read_back_as_it_was():
    pixels = np.random.default_rng(1).integers(0, 256, (7, 5, 3), dtype=np.uint8)
    assert np.array_equal(np.array(Image.open(io.BytesIO(png(pixels)))), pixels)


def test_a_restarted_robot_leaves_nothing_of_its_old_map(field: Field, view: View):
    former = field.robot(session="first")
    former.publish_map(1)
    field.forward(former, 0.1)
    view.scene.update(field.link.robot("weaver"))
    assert view.names("/world/terrain/")
    field.forward(field.robot(session="second"), 0.2)
    view.scene.update(field.link.robot("weaver"))
    assert not view.names("/world/terrain/")
    view.scene.update(None)
    assert not view.names("/world")


def test_a_state_that_is_no_state_of_this_robot_is_not_drawn(field: Field, view: View):
    robot = field.robot()
    field.forward(robot, 0.1)
    record = field.link.robot("weaver")
    view.scene.update(record)
    before = np.array(view.node("/world/robot").position)
    good = robot.state(1)
    for damaged in (
        dataclasses.replace(good, joint_position=np.zeros(18)),
        dataclasses.replace(good, position_in_world=np.full(3, np.nan)),
        dataclasses.replace(good, wxyz=np.zeros(4)),
        dataclasses.replace(good, foot_contact=np.zeros(0, dtype=bool)),
    ):
        field.bus.publish("weaver", topics.STATE, damaged)
        view.scene.update(record)
        assert np.allclose(view.node("/world/robot").position, before)


def test_the_view_is_reached_through_the_console_with_its_own_subprotocol(console: Console):
    with console.page() as socket:
        hello = Page(socket).hear("hello")
        assert re.fullmatch(r"/viser/[0-9a-f]{32}/", hello["scene"])
        html = console.http.get(hello["scene"])
        assert html.status_code == 200
        assert "weaver-scene" in html.text
        assert "frame-ancestors 'self'" in html.headers["content-security-policy"]
        viser = __import__("viser")
        with console.connect(hello["scene"], subprotocols=[f"viser-v{viser.__version__}"]) as scene:
            assert isinstance(scene.recv(timeout=10.0), bytes)
            scene.send(b"ShareUrlRequest")
        with pytest.raises(InvalidStatus):
            console.connect(hello["scene"])
    with console.page() as socket:
        assert Page(socket).hear("hello")["scene"] == hello["scene"]  # a page that returns keeps its view


def test_the_sandboxed_view_needs_no_cookie_but_its_own_secret(guarded: Console):
    with guarded.page(additional_headers=guarded.log_in("anna")) as socket:
        scene = Page(socket).hear("hello")["scene"]
        assert guarded.http.get(scene, headers={"origin": "null"}).status_code == 200
        assert guarded.http.get(scene, headers={"origin": "http://evil.example"}).status_code == 403
        assert guarded.http.get("/viser/page-0001/", headers={"origin": "null"}).status_code == 401
        assert guarded.http.get("/api/robots", headers={"origin": "null"}).status_code == 403
        viser = __import__("viser")
        protocol = f"viser-v{viser.__version__}"
        with guarded.connect(scene, subprotocols=[protocol], origin="null") as view:
            assert isinstance(view.recv(timeout=10.0), bytes)
    left = (guarded.http.get(scene).status_code == 401 for _ in range(1000))  # the console hears of it a moment later
    assert any(left)


def test_there_is_no_view_for_a_page_that_is_not_connected(console: Console):
    assert console.http.get("/viser/page-9999/").status_code == 404
    with pytest.raises(InvalidStatus):
        console.connect("/viser/page-9999/", subprotocols=["viser-v1"])


def test_the_view_carries_the_shim_before_anything_of_visers():
    import gzip

    text = gzip.decompress(scene_page()).decode()
    assert text.index("weaver-scene") < text.index("<title>")
    assert "https://" not in text[: text.index("</style>")]


directions = st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)).filter(lambda v: np.linalg.norm(v) > 1e-3)


@given(directions)
def test_the_shortest_rotation_takes_z_to_the_direction(vector):
    direction = np.array(vector) / np.linalg.norm(vector)
    (wxyz,) = turn_z_to(direction[None])
    assert np.allclose(rotation_from_wxyz(wxyz) @ [0.0, 0.0, 1.0], direction, atol=1e-6)


def test_links_span_the_leg_from_hip_to_foot():
    robot = load_robot("weaver")
    frames = joint_frames_in_body(robot, STANDING)
    middles, wxyzs, lengths = segments(frames, np.array([1, 2, 3, 4]))
    assert lengths.reshape(6, 4).sum(axis=1) == pytest.approx(np.full(6, 0.34))
    along = np.array([rotation_from_wxyz(wxyz)[:, 2] for wxyz in wxyzs])
    ends = (middles + 0.5 * lengths[:, None] * along).reshape(6, 4, 3)[:, -1]
    assert np.allclose(ends, frames[:, -1, :3, 3])


@pytest.mark.parametrize("shape", [prism(), octasphere()])
def test_shapes_are_closed_and_face_outwards(shape):
    vertices, faces = shape
    corners = vertices[faces].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ij,ij->i", normals, corners.mean(axis=1)) > 0.0).all()
    edges = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).tolist()
    assert sorted(map(tuple, edges)) == sorted((b, a) for a, b in edges)


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=3, max_size=6, unique=True))
def test_the_support_polygon_has_every_foot_on_its_left(feet):
    points = np.column_stack([np.array(feet), np.zeros(len(feet))])
    hull = closed_hull(points)
    assert np.array_equal(hull[0], hull[-1])
    for a, b in pairwise(hull):
        turns = (b[0] - a[0]) * (points[:, 1] - a[1]) - (b[1] - a[1]) * (points[:, 0] - a[0])
        assert (turns >= -1e-9).all()
