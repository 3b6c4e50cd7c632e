"""From the simulated robot to the twin and back, and to a real one, as an operator does it on the page."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from visitors import DESK, PHONE, ROBOT_ID
from wire_robot import WireRobot

from weaver_shared.messages import Waypoint

pytestmark = pytest.mark.browser

TWIN, REAL = "twin-1", "real-1"


@pytest.fixture
def stage(own_stage: Any) -> Any:
    return own_stage


@pytest.fixture
def joined(stage: Any) -> Iterator[Callable[[str, str], WireRobot]]:
    """Lets further robots of a kind join."""
    robots: list[WireRobot] = []

    def join(name: str, kind: str) -> WireRobot:
        robots.append(WireRobot(stage.robot.bus, name, kind=kind))
        robots[-1].start()
        return robots[-1]

    yield join
    for robot in robots:
        robot.stop()


def pick(visitor: Any, robot: str) -> None:
    visitor.page.get_by_role("combobox", name="Robot", exact=True).select_option(robot)


def test_an_operator_goes_to_the_twin_and_back(
    visit: Callable[..., Any], joined: Callable[[str, str], WireRobot]
) -> None:
    anna = visit("anna")
    anna.page.get_by_text("Simulated robot").wait_for()
    twin = joined(TWIN, "EMULATED BUS")
    pick(anna, TWIN)
    anna.page.get_by_text("Emulated servo bus").wait_for()
    anna.stand()
    assert twin.mode == "STAND"
    anna.press("Release control")
    anna.button("Take control").wait_for()
    pick(anna, ROBOT_ID)
    anna.page.get_by_text("Simulated robot").wait_for()
    anna.see_state("SIT")


def test_nobody_leaves_a_robot_that_walks_under_them(
    visit: Callable[..., Any], stage: Any, joined: Callable[[str, str], WireRobot]
) -> None:
    anna = visit("anna")
    joined(TWIN, "EMULATED BUS")
    anna.stand()
    stage.robot.waypoints = (Waypoint(x=50.0, y=0.0),)
    stage.robot.mode = "WALK"
    anna.see_state("WALK")
    picker = anna.page.get_by_role("combobox", name="Robot", exact=True)
    assert picker.is_disabled()
    assert "pause or stop it first" in picker.get_attribute("title")
    stage.robot.mode = "STAND"
    anna.see_state("STAND")
    pick(anna, TWIN)
    anna.page.get_by_text("Emulated servo bus").wait_for()


@pytest.mark.parametrize("size", [DESK, PHONE], ids=["desk", "phone"])
def test_a_real_robot_is_taken_only_after_a_look_at_it(
    visit: Callable[..., Any],
    joined: Callable[[str, str], WireRobot],
    picture: Callable[..., None],
    size: tuple[int, int],
) -> None:
    anna = visit("anna", size=size)
    real = joined(REAL, "REAL")
    pick(anna, REAL)
    anna.page.get_by_text("Real robot: motors move").wait_for()
    anna.press("Take control")
    dialog = anna.page.get_by_role("dialog")
    dialog.get_by_text("Battery:").wait_for()
    dialog.get_by_text("Self-test: nothing is wrong").wait_for()
    anna.button("Yes, it is real").click(trial=True)  # has come to rest
    picture(anna, f"real-robot-{size[0]}", dialog if size == DESK else None)
    anna.press("Leave it")
    dialog.wait_for(state="hidden")
    assert real.holder == ""
    anna.press("Take control")
    anna.press("Yes, it is real")
    anna.button("Release control").wait_for()
    assert real.holder == "anna"
