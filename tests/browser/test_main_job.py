"""The main job as a person does it, in a real browser: take control, click waypoints on the ground, walk, stop."""

from __future__ import annotations

import contextlib
import re
import time
from collections.abc import Callable, Iterator
from typing import Any, ClassVar

import numpy as np
import pytest
from visitors import CHROMIUM, WITHOUT_WEBGL

from weaver_console.scene.ground import UNKNOWN_MM, Ground
from weaver_console.scene.page_scene import CAMERA_FROM_ROBOT, LOOK_FROM_ROBOT
from weaver_shared import topics
from weaver_shared.messages import MapTile

pytest.importorskip("pybullet")
playwright = pytest.importorskip("playwright.sync_api")
expect, Late = playwright.expect, playwright.TimeoutError

ROBOT_ID = "browser-1"
FIELD_OF_VIEW = np.deg2rad(75.0)  # viser's, vertical
GROWN_AREA = 0.3  # m2; the cameras see a strip about 1 m wide, and the robot goes on for most of a metre
PATIENT = 30_000.0  # ms; a page drawn without a graphics card answers late

pytestmark = pytest.mark.skipif(not CHROMIUM.exists(), reason="Chromium is not installed")


@pytest.fixture(scope="module")
def product(start_product: Callable[..., Any]) -> Any:
    return start_product("--world", "testbed", "--robot-id", ROBOT_ID, "--seed", "1")


@pytest.fixture(scope="module")
def browser(chromium: Callable[..., Any]) -> Any:
    return chromium()


@pytest.fixture
def robot(product: Any, listen: Callable[..., Any]) -> Any:
    """What the robot says on the bus, with every tile of its map and every event."""
    robot = listen(product.endpoint, ROBOT_ID)
    robot.ground, robot.events, robot.speeds = Ground(), [], []
    robot.bus.subscribe(ROBOT_ID, topics.MAP_TILE, lambda _robot, _key, tile: _put(robot.ground, tile))
    robot.bus.subscribe(ROBOT_ID, topics.EVENT, lambda _robot, _key, event: robot.events.append(event))
    robot.bus.subscribe(
        ROBOT_ID,
        topics.STATE,
        lambda _robot, _key, state: robot.speeds.append((state.stamp_ns, float(np.abs(state.velocity_command).max()))),
    )
    robot.bus.watch(lambda _robot, _process, _came: None)  # a bus that watches fetches the map drawn before it came
    robot.hear(topics.MODE, topics.STATE, topics.TRUTH, topics.ADAPTATION, topics.LEASE, topics.MISSION)
    return robot


def _put(ground: Ground, tile: MapTile) -> None:
    ground.put(tile)


@pytest.fixture(autouse=True)
def everybody_leaves() -> Iterator[None]:
    """Close the pages a test leaves open, or their operators would hold the robot in the next one."""
    yield
    while Operator.present:
        Operator.present.pop().close()


CALM = """
() => new Promise((done) => {
  const begun = performance.now();
  let last = begun, calm = 0;
  const look = () => {
    const now = performance.now();
    calm = now - last < 400 ? calm + 1 : 0;
    last = now;
    if (calm >= 30 || now - begun > 90_000) done(calm);
    else setTimeout(look, 100);
  };
  look();
})
"""


class Operator:
    """A person at a page of their own; `name` is what the page calls them."""

    present: ClassVar[list[Operator]] = []

    def __init__(self, browser: Any, address: str, name: str, *, webgl: bool = True) -> None:
        self.context = browser.new_context(viewport={"width": 1440, "height": 900})
        Operator.present.append(self)
        if not webgl:
            self.context.add_init_script(WITHOUT_WEBGL)
        self.context.add_init_script(f"localStorage.setItem('weaver.operator', '{name}')")
        self.page = self.context.new_page()
        self.requested: list[str] = []
        self.page.on("request", lambda request: self.requested.append(request.url))
        self.page.goto(address)
        picker = self.page.get_by_role("combobox", name="Robot", exact=True)
        expect(picker).to_contain_text(ROBOT_ID, timeout=PATIENT)
        picker.select_option(ROBOT_ID)
        expect(self.page.get_by_role("status", name="Robot status")).to_contain_text(
            re.compile("HOLD|STAND|SIT|READY|ESTOP|WALK"), timeout=PATIENT
        )

    def button(self, name: str) -> Any:
        return self.page.get_by_role("button", name=name)

    def press(self, name: str) -> None:
        self.button(name).click(timeout=PATIENT)

    def press_in_control(self, name: str) -> None:
        """As a person does whose page was too busy to be heard for two seconds: take control again, and go on."""
        for _ in range(5):
            if self.button("Take control").is_visible():
                self.press("Take control")
            with contextlib.suppress(Late):
                self.button(name).click(timeout=6_000.0)
                return
        self.press(name)

    def wait_for_calm(self) -> None:
        """Until the page has answered at once for three seconds, but no longer than a minute and a half."""
        self.page.evaluate(CALM)

    @property
    def waypoints(self) -> Any:
        return self.page.get_by_role("list", name="Waypoints").get_by_role("listitem")

    def click_ground(self, place: np.ndarray, robot_position: np.ndarray) -> None:
        """Click a place (3,) of the 3-D view, as the camera sees it that was put behind `robot_position`."""
        before = self.waypoints.count()
        view = self.page.locator("iframe").bounding_box()
        across, down = _project(place, robot_position, view["width"] / view["height"])
        self.page.mouse.click(view["x"] + across * view["width"], view["y"] + down * view["height"])
        expect(self.waypoints).to_have_count(before + 1, timeout=PATIENT)

    def close(self) -> None:
        self.context.close()


def _project(place: np.ndarray, robot_position: np.ndarray, aspect: float) -> tuple[float, float]:
    """Shares of the view's width and height at which a place (3,) in world is seen."""
    eye, target = robot_position + CAMERA_FROM_ROBOT, robot_position + LOOK_FROM_ROBOT
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    seen = place - eye
    scale = np.tan(FIELD_OF_VIEW / 2) * float(seen @ forward)
    return 0.5 + 0.5 * float(seen @ right) / (scale * aspect), 0.5 - 0.5 * float(seen @ up) / scale


def _on_ground(ground: Ground, near: tuple[float, float]) -> np.ndarray:
    """The known place nearest to (x, y), (3,)."""
    grid = ground.grid()
    assert grid is not None
    rows, columns = np.nonzero(np.isfinite(grid.elevation))
    x, y = grid.origin[0] + rows * grid.cell, grid.origin[1] + columns * grid.cell
    nearest = int(np.argmin(np.hypot(x - near[0], y - near[1])))
    return np.array([x[nearest], y[nearest], grid.elevation[rows[nearest], columns[nearest]]])


def _is_known(ground: Ground, near: tuple[float, float]) -> bool:
    """Whether there is a known place within 5 cm of (x, y)."""
    return bool(np.hypot(*(_on_ground(ground, near)[:2] - near)) < 0.05)


def _known_area(ground: Any) -> float:
    """Area of the cells that hold a height, m2."""
    return float(sum((tile.elevation_mm != UNKNOWN_MM).sum() * tile.cell**2 for tile in ground.tiles.values()))


def test_a_person_walks_the_robot_to_two_clicked_waypoints_and_stops_it(product: Any, browser: Any, robot: Any) -> None:
    robot.wait_until(lambda _: len(robot.ground.tiles) > 3, 90.0, "there is no map")
    anna = Operator(browser, product.address, "anna")
    time.sleep(15.0)  # the 3-D view of a machine without a graphics card fills slowly, and nothing on the page tells
    anna.wait_for_calm()
    begun_at = np.array(robot.newest["tele/state"].position_in_world)
    anna.press("Take control")
    expect(anna.button("Release control")).to_be_visible(timeout=PATIENT)
    robot.wait_until(lambda newest: newest["state/lease"].holder == "anna", 5.0, "the robot does not know its operator")
    anna.press_in_control("Stand")
    robot.wait_until(lambda newest: newest["state/mode"].mode == "STAND", 30.0, "it does not stand")

    _look_closely(anna, robot)
    known_at_start = _known_area(robot.ground)
    clicked = []
    for ahead, aside in ((0.9, 0.1), (1.4, -0.1)):
        wanted = (begun_at[0] + ahead, begun_at[1] + aside)
        robot.wait_until(lambda _, near=wanted: _is_known(robot.ground, near), 30.0, f"nothing is known at {wanted}")
        clicked.append(_on_ground(robot.ground, wanted))
        anna.click_ground(clicked[-1], begun_at)
    anna.press("Start mission")
    robot.wait_until(lambda newest: newest["state/mode"].mode == "WALK", 15.0, "it does not walk")
    robot.wait_until(lambda newest: len(newest["state/mission"].waypoints) == 2, 5.0, "the mission is not told")
    first, last = robot.newest["state/mission"].waypoints
    assert np.hypot(*(clicked[0][:2] - [first.x, first.y])) < 0.2
    assert np.hypot(*(clicked[1][:2] - [last.x, last.y])) < 0.2

    _override_and_release(anna, robot)
    robot.wait_until(
        lambda newest: np.hypot(*(newest["truth/state"].position_in_world[:2] - [last.x, last.y])) < 0.5,
        240.0,
        "it does not come within 0.5 m of the last waypoint",
    )
    grown = _known_area(robot.ground) - known_at_start
    assert grown > GROWN_AREA, f"the tiles have grown by {grown:.2f} m2 only along its way"

    _stop_while_walking(anna, robot, last)
    assert {url.split("/")[2] for url in anna.requested if url.startswith(("http", "ws"))} == {
        product.address.split("/")[2]
    }


def _look_closely(anna: Operator, robot: Any) -> None:
    anna.press("Look closely")
    expect(anna.page.get_by_text(re.compile("Look closely(: the look is still| measured [0-9]+ cells)"))).to_be_visible(
        timeout=PATIENT
    )
    robot.wait_until(
        lambda _: any("close look measured" in event.text for event in robot.events), 15.0, "no close look is told of"
    )
    expect(anna.page.get_by_role("log", name="Events")).to_contain_text("cells, typically to", timeout=PATIENT)


def _override_and_release(anna: Operator, robot: Any) -> None:
    group = anna.page.get_by_role("group", name="Adaptation")
    switch = group.get_by_role("switch", name="Override Virtual stiffness")
    slider = group.get_by_role("slider", name="Virtual stiffness")
    switch.click(timeout=PATIENT, force=True)
    robot.wait_until(lambda n: "virtual_stiffness" in n["tele/adaptation"].overridden, 15.0, "no override is applied")
    slider.fill("900")
    robot.wait_until(
        lambda n: abs(n["tele/adaptation"].applied.virtual_stiffness - 900.0) < 20.0,
        15.0,
        "it is not the value asked for",
    )
    expect(slider).to_have_attribute("aria-valuetext", re.compile("^(8[89]|9[01])[0-9]"), timeout=PATIENT)
    switch.click(timeout=PATIENT, force=True)
    robot.wait_until(lambda n: not n["tele/adaptation"].overridden, 15.0, "the override is not released")


def _stop_while_walking(anna: Operator, robot: Any, last: Any) -> None:
    robot.wait_until(lambda newest: newest["state/mission"].phase == "done", 120.0, "the mission does not end")
    anna.press("Clear waypoints")
    box = anna.page.get_by_role("application", name="Map").bounding_box()
    anna.page.mouse.click(box["x"] + 0.8 * box["width"], box["y"] + 0.5 * box["height"])
    expect(anna.waypoints.first).to_be_visible(timeout=PATIENT)
    anna.press("Start mission")
    robot.wait_until(lambda newest: newest["tele/state"].velocity_command.any(), 60.0, "it does not walk again")
    anna.press("Stop robot")
    robot.wait_until(lambda newest: newest["state/mode"].stopped, 10.0, "it does not stop")
    robot.wait_until(lambda _: _stops(robot, "anna"), 10.0, "nobody says who stopped it")
    stopped_ns = _stops(robot, "anna")[0]
    moving = [stamp for stamp, speed in robot.speeds if speed > 0.0]
    assert max(moving) - stopped_ns < 0.2e9
    expect(anna.page.get_by_role("status", name="Robot status")).to_contain_text("ESTOP", timeout=PATIENT)
    time.sleep(1.0)
    assert robot.newest["state/mode"].mode == "ESTOP"
    assert not robot.newest["tele/state"].velocity_command.any()


def _stops(robot: Any, operator: str) -> list[int]:
    """Stamps of an operator's stops in the event log, ns."""
    return [event.stamp_ns for event in robot.events if event.source == operator and "stop" in event.text.lower()]


def test_a_second_page_watches_may_not_command_and_may_stop(product: Any, browser: Any, robot: Any) -> None:
    robot.wait_until(lambda newest: newest["state/mode"].mode, 30.0, "there is no robot")
    # An anna who comes within 2 s of the last test's has control still, as after reloading her page.
    robot.wait_until(lambda newest: not newest["state/lease"].holder, 15.0, "control of a closed page does not expire")
    anna = Operator(browser, product.address, "anna", webgl=False)
    ben = Operator(browser, product.address, "ben", webgl=False)
    anna.press("Take control")
    robot.wait_until(lambda newest: newest["state/lease"].holder == "anna", 15.0, "anna has no control")
    if robot.newest["state/mode"].stopped:
        robot.wait_until(lambda newest: "release_stop" in newest["state/mode"].allowed, 30.0, "it does not settle")
        anna.press("Release stop")
        robot.wait_until(lambda newest: not newest["state/mode"].stopped, 15.0, "the stop is not released")
    anna.press("Stand")
    robot.wait_until(lambda newest: newest["state/mode"].mode == "STAND", 60.0, "it does not stand")

    expect(ben.page.get_by_text("anna has control")).to_be_visible(timeout=PATIENT)
    expect(ben.page.get_by_role("status", name="Robot status")).to_contain_text("STAND", timeout=PATIENT)
    for name in ("Stand", "Sit", "Start mission"):
        expect(ben.button(name)).to_be_disabled(timeout=PATIENT)
    ben.page.locator("body").press("Escape")
    robot.wait_until(lambda newest: newest["state/mode"].stopped, 15.0, "ben's stop does not stop it")
    expect(anna.page.get_by_role("status", name="Robot status")).to_contain_text("ESTOP", timeout=PATIENT)
    robot.wait_until(lambda _: _stops(robot, "ben"), 10.0, "nobody says who stopped it")
