"""The map and the 3-D view under mouse, finger and keys."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from visitors import DESK, PHONE, map_of, within
from wire_robot import ground_height

from weaver_console.scene.page_scene import CAMERA_FROM_ROBOT, LOOK_FROM_ROBOT

pytestmark = pytest.mark.browser

FIELD_OF_VIEW = np.deg2rad(75.0)  # viser's, vertical
FLAT_PLACE = (1.0, 0.0)


def test_the_map_is_edited_by_mouse_and_by_keys(visit: Callable[..., Any], picture: Callable[..., None]) -> None:
    anna = visit()
    box = map_of(anna).bounding_box()
    for across in (0.6, 0.8):
        anna.page.mouse.click(*within(box, across, 0.5))
    anna.page.mouse.move(*within(box, 0.8, 0.5))
    anna.page.mouse.down()
    anna.page.mouse.move(*within(box, 0.75, 0.3), steps=3)
    anna.page.mouse.up()
    dragged = anna.waypoints.nth(1).get_by_label(re.compile("^y of")).input_value()
    assert float(dragged) > 0.3
    map_of(anna).focus()
    for key, count in (("Enter", 3), ("Shift+Enter", 4), ("Delete", 3), ("Control+z", 4), ("Control+Shift+Z", 3)):
        map_of(anna).press(key)
        anna.waypoints.nth(count - 1).wait_for()
        assert anna.waypoints.count() == count, key
    anna.press("Move waypoint 2 up")
    assert anna.waypoints.nth(0).get_by_label(re.compile("^y of")).input_value() == dragged
    picture(anna, "mission")


def test_layers_have_legends_with_units_and_unknown_ground_apart(visit: Callable[..., Any]) -> None:
    anna = visit()
    layers = anna.page.get_by_role("combobox", name="Terrain layer")
    legend = anna.page.locator(".legend")
    for layer, unit in (("Uncertainty", "0.06 m"), ("Age", "254 s"), ("Roughness", "0 to 1"), ("Elevation", " m")):
        layers.select_option(layer)
        legend.filter(has_text=unit).filter(has_text="unknown").wait_for()


def test_a_distance_is_measured_and_the_map_saved_as_a_picture(
    visit: Callable[..., Any], picture: Callable[..., None]
) -> None:
    anna = visit()
    anna.press("View options")
    anna.page.get_by_role("menuitemcheckbox", name=re.compile("Contour lines")).click()
    anna.press("View options")
    anna.press("Measure")
    anna.page.get_by_text("choose the first place").wait_for()
    anna.wait_for_layout()
    box = map_of(anna).bounding_box()
    anna.page.mouse.click(*within(box, 0.4, 0.5))
    anna.page.get_by_text("choose the second place").wait_for()
    anna.page.mouse.click(*within(box, 0.6, 0.5))
    measured = anna.page.get_by_role("status", name="Measured")
    measured.filter(has_text=re.compile(r"[0-9.]+ m, 0\.[0-9]+ m (up|down), [0-9]+°")).wait_for()
    assert anna.waypoints.count() == 0
    picture(anna, "measure")
    with anna.page.expect_download() as saved:
        anna.press("Save picture")
    assert saved.value.suggested_filename.startswith("weaver_map_")


def test_a_tap_on_a_phone_places_a_waypoint(visit: Callable[..., Any], picture: Callable[..., None]) -> None:
    anna = visit(size=PHONE, has_touch=True, is_mobile=True)
    map_of(anna).scroll_into_view_if_needed()
    anna.page.touchscreen.tap(*within(map_of(anna).bounding_box(), 0.6, 0.4))
    anna.waypoints.first.wait_for()
    picture(anna, "phone")
    assert anna.page.evaluate("document.documentElement.scrollWidth") <= PHONE[0]


def _seen(place: np.ndarray, robot: np.ndarray, aspect: float) -> tuple[float, float]:
    """Shares of the 3-D view's width and height at which a place (3,) in world is seen."""
    eye, target = robot + CAMERA_FROM_ROBOT, robot + LOOK_FROM_ROBOT
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    seen, up = place - eye, np.cross(right, forward)
    scale = np.tan(FIELD_OF_VIEW / 2) * float(seen @ forward)
    return 0.5 + 0.5 * float(seen @ right) / (scale * aspect), 0.5 - 0.5 * float(seen @ up) / scale


def _ground(x: float, y: float, above: float = 0.0) -> np.ndarray:
    return np.array([x, y, float(ground_height(np.array([x]), np.array([y]))[0]) + above])


def test_the_3d_view_places_and_drags_waypoints_and_stops_by_key(
    visit: Callable[..., Any], stage: Any, picture: Callable[..., None]
) -> None:
    anna = visit(scene=True, size=DESK)
    robot = stage.robot.state(0).position_in_world
    frame = anna.page.locator("iframe.scene")
    frame.wait_for()
    _until(anna, lambda: any(scene.watched and scene._shown for scene in stage.hub._scenes.values()))
    anna.page.wait_for_timeout(3000)
    box = frame.bounding_box()
    aspect = box["width"] / box["height"]
    anna.page.mouse.click(*within(box, *_seen(_ground(*FLAT_PLACE), robot, aspect)))
    anna.waypoints.first.wait_for()
    x, y = (float(anna.waypoints.first.get_by_label(re.compile(f"^{axis} of")).input_value()) for axis in "xy")
    assert np.hypot(x - FLAT_PLACE[0], y - FLAT_PLACE[1]) < 0.06
    anna.page.wait_for_timeout(3000)
    anna.page.mouse.move(*within(box, *_seen(_ground(x, y, above=0.30), robot, aspect)))
    anna.page.wait_for_timeout(1000)
    anna.page.mouse.down()
    to = _seen(_ground(x, y, above=0.30), robot, aspect)
    for step in (0.02, 0.05, 0.08, 0.1):
        anna.page.mouse.move(*within(box, to[0] + step, to[1]))
        anna.page.wait_for_timeout(400)
    anna.page.mouse.up()
    row = anna.waypoints.first.get_by_label(re.compile("^y of"))
    _until(anna, lambda: abs(float(row.input_value()) - y) > 0.05)
    assert anna.waypoints.count() == 1
    picture(anna, "scene")
    anna.page.mouse.click(*within(box, 0.5, 0.05))  # the focus goes into the frame
    anna.page.keyboard.press("Space")
    anna.see_state("ESTOP")
    assert stage.robot.stopped
    hosts = {address.split("/")[2] for address in anna.requested if address.startswith(("http", "ws"))}
    assert hosts == {stage.address.split("/")[2]}
    assert any("/viser/" in address for address in anna.requested)


def _until(visitor: Any, holds: Callable[[], bool], seconds: float = 25.0) -> None:
    for _ in range(round(seconds / 0.1)):
        if holds():
            return
        visitor.page.wait_for_timeout(100)
    raise TimeoutError("it did not happen")
