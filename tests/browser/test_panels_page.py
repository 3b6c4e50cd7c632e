"""Driving by hand, the adaptation, joints and alerts, by the names that everybody uses."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

from weaver_shared import topics
from weaver_shared.messages import TeleopFrame

pytestmark = pytest.mark.browser

GAMEPAD = """
window.pad = { connected: true, id: "a gamepad", axes: [0, -1, 0, 0], buttons: Array(16).fill({ pressed: false }) };
navigator.getGamepads = () => [window.pad];
"""


@pytest.fixture
def driven(stage: Any) -> list[TeleopFrame]:
    frames: list[TeleopFrame] = []
    stage.robot.bus.subscribe(stage.robot.robot_id, topics.TELEOP, lambda _id, _key, frame: frames.append(frame))
    return frames


def _wait(visitor: Any, holds: Callable[[], bool]) -> None:
    for _ in range(100):
        if holds():
            return
        visitor.page.wait_for_timeout(50)
    raise TimeoutError("it did not happen")


def test_driving_by_keys_and_gamepad_ends_when_the_hand_leaves(
    visit: Callable[..., Any], driven: list[TeleopFrame], picture: Callable[..., None]
) -> None:
    anna = visit()
    anna.stand()
    anna.page.get_by_role("slider", name="Speed limit").fill("0.5")
    anna.page.get_by_role("switch", name="Keyboard driving").click(force=True)
    anna.page.keyboard.down("Shift")
    anna.page.keyboard.down("w")
    _wait(anna, lambda: any(frame.dead_man and 0.05 < frame.forward <= 0.5 for frame in driven))
    picture(anna, "driving", anna.part("Drive by hand"))
    anna.page.keyboard.up("w")
    anna.page.keyboard.up("Shift")
    _wait(anna, lambda: not driven[-1].dead_man)
    assert (driven[-1].forward, driven[-1].turn) == (0.0, 0.0)
    driven.clear()
    anna.page.evaluate(GAMEPAD + "window.pad.buttons[5] = { pressed: true };")
    _wait(anna, lambda: any(frame.dead_man and frame.forward > 0.05 for frame in driven))
    anna.page.evaluate("window.pad.connected = false; window.dispatchEvent(new Event('gamepaddisconnected'))")
    _wait(anna, lambda: not driven[-1].dead_man)
    anna.page.get_by_text(re.compile("^Round trip [0-9]+ ms")).wait_for()
    picture(anna, "body", anna.part("Body and legs"))


def test_the_adaptation_shows_where_on_its_polynomials_the_robot_is(
    visit: Callable[..., Any], stage: Any, picture: Callable[..., None]
) -> None:
    anna = visit()
    anna.stand()
    group = anna.page.get_by_role("group", name="Adaptation")
    group.get_by_role("img", name="Virtual stiffness over roughness: now at 0.20, give or take 0.05").wait_for()
    group.get_by_role("img", name="Stride height over step height: now at 0.10, give or take 0.05").wait_for()
    group.get_by_role("img", name="Stride frequency over the last minute").wait_for()
    group.get_by_text("vision").wait_for()
    group.get_by_role("combobox", name="Override lasts").select_option("60")
    group.get_by_role("switch", name="Override Stride height").click(force=True)
    _wait(anna, lambda: "stride_height" in stage.robot.overrides)
    group.get_by_role("slider", name="Stride height").fill("0.1")
    _wait(anna, lambda: abs(stage.robot.overrides.get("stride_height", 0.0) - 0.1) < 1e-6)
    asked = [command for command in stage.robot.commands if command.name == "stride_height"]
    assert {command.seconds for command in asked} == {60.0}
    group.get_by_text("0.100").first.wait_for()
    picture(anna, "adaptation", anna.part("Adaptation"))


def test_paper_mode_is_asked_of_the_robot_and_shown_as_it_reports_it(visit: Callable[..., Any], stage: Any) -> None:
    anna = visit()
    mode = anna.page.get_by_role("group", name="Adaptation").get_by_role("switch", name="Paper mode")
    assert mode.is_disabled()
    anna.stand()
    mode.click(force=True)
    anna.page.get_by_text("The ground is judged as published").wait_for()
    assert mode.is_checked()
    assert stage.robot.perception == "paper"
    anna.page.get_by_role("log", name="Events").get_by_text("set_perception: accepted").wait_for()
    mode.press("Enter")
    anna.page.get_by_text("The ground is judged robustly").wait_for()
    assert not mode.is_checked()


def test_a_setting_is_found_and_set_within_its_bounds(
    visit: Callable[..., Any], stage: Any, picture: Callable[..., None]
) -> None:
    anna = visit()
    anna.stand()
    anna.page.get_by_role("searchbox", name="Search settings").fill("height")
    settings = anna.page.get_by_role("list", name="Settings").get_by_role("listitem")
    settings.filter(has_text="0.030 to 0.140 m").wait_for()
    assert settings.count() == 1
    field = settings.get_by_role("textbox", name="Set Stride height in m")
    field.fill("0.5")
    field.press("Enter")
    anna.page.get_by_text("Stride height was not set: it goes from 0.030 to 0.140 m.").wait_for()
    assert stage.robot.overrides == {}
    field.fill("0.1")
    field.press("Enter")
    _wait(anna, lambda: stage.robot.overrides.get("stride_height") == 0.1)
    _wait(anna, lambda: field.input_value() == "0.100")
    picture(anna, "settings", anna.part("Settings"))


def test_tracked_features_are_drawn_over_the_picture_when_asked_for(
    visit: Callable[..., Any], picture: Callable[..., None]
) -> None:
    anna = visit()
    anna.page.get_by_role("img", name="Picture of camera left").wait_for()
    marks = anna.page.get_by_role("img", name="Tracked features: 16 in both eyes, 5 in one eye, 3 rejected")
    assert marks.count() == 0
    anna.page.get_by_role("switch", name="Tracked features").click(force=True)
    marks.wait_for()
    circles, crosses = (marks.locator(f"path.feature-{kind}").get_attribute("d") for kind in ("both_eyes", "rejected"))
    assert (circles.count("M"), crosses.count("M")) == (16, 3)
    assert "a" in circles
    assert "a" not in crosses
    picture(anna, "features", anna.page.locator(".camera").filter(has=marks))


def test_joints_alerts_and_pictures_are_there(
    visit: Callable[..., Any], stage: Any, picture: Callable[..., None]
) -> None:
    anna = visit()
    assert anna.page.get_by_role("list", name="Alerts").count() == 0
    anna.page.get_by_text("States", exact=True).click()
    states = anna.page.get_by_role("table", name="States").locator("tbody tr")
    assert states.count() == 8
    assert re.search(r"SIT\s*sitting down\s*Stand", states.and_(anna.page.locator("[aria-current]")).inner_text())
    anna.page.locator(".health .reading", has_text="Energy used").filter(has_text=re.compile("[0-9]kJ")).wait_for()
    anna.page.get_by_text("States", exact=True).click()
    anna.page.get_by_text("Joints", exact=True).click()
    rows = anna.page.get_by_role("table", name="Joints").locator("tbody tr")
    rows.first.wait_for()
    assert rows.count() == 30
    first = re.compile(r"-?[0-9.]+\s*-69 to 69\s*-1\.0\s*30\s*–", re.DOTALL)
    rows.first.filter(has_text=first).wait_for()
    anna.page.get_by_text("Errors are not measured on this robot.").wait_for()
    stage.robot.temperature, stage.robot.faults = 76.0, ("", "has shut down: overload") + ("",) * 28
    rows.last.filter(has_text=re.compile(r"76 hot\s*none")).wait_for()
    rows.filter(has_text=re.compile("[67][0-9] warm")).first.wait_for()
    rows.nth(1).filter(has_text="! has shut down: overload").wait_for()
    anna.page.set_viewport_size({"width": 1440, "height": 2000})
    picture(anna, "joints", anna.part("Robot"))
    stage.robot.temperature, stage.robot.real_time_factor = 71.0, 0.4
    alerts = anna.page.get_by_role("list", name="Alerts")
    alerts.get_by_text("a servo is at 71 °C").wait_for()
    alerts.get_by_text("Let it rest").wait_for()
    alerts.get_by_text("simulated time runs slower").wait_for()
    anna.page.get_by_role("img", name="Picture of camera left").wait_for()
    anna.page.get_by_role("img", name=re.compile("^Gait diagram, in swing")).wait_for()
    picture(anna, "health", anna.part("Health"))
