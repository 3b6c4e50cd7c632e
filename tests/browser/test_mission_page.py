"""A mission from the first click to the way back, with ground that is forbidden."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from visitors import map_of, within

from weaver_shared.messages import CommandName

pytestmark = pytest.mark.browser


def _with_a_waypoint(visit: Callable[..., Any]) -> tuple[Any, dict[str, float]]:
    """Somebody in control of a standing robot with a waypoint ahead, and where their map is."""
    anna = visit()
    anna.stand()
    box = map_of(anna).bounding_box()
    anna.page.mouse.click(*within(box, 0.85, 0.5))
    anna.waypoints.first.wait_for()
    return anna, box


def test_a_way_through_forbidden_ground_is_refused_until_the_area_is_gone(
    visit: Callable[..., Any], stage: Any, picture: Callable[..., None]
) -> None:
    anna, box = _with_a_waypoint(visit)
    anna.press("Forbid an area")
    for across, down in ((0.6, 0.4), (0.7, 0.4), (0.7, 0.6)):
        anna.page.mouse.click(*within(box, across, down))
    map_of(anna).focus()
    map_of(anna).press("Enter")  # a fourth corner by key, in the middle of the map
    anna.press("Take back corner")
    anna.press("Close area")
    anna.page.get_by_text("Refused: the way to waypoint 1 leads into forbidden area 1").wait_for()
    assert anna.button("Start mission").is_disabled()
    anna.page.get_by_text("The robot keeps out of them").wait_for()  # without a mission, as soon as it is closed
    assert [len(area) for area in stage.robot.areas] == [3]
    picture(anna, "forbidden")

    anna.page.get_by_text(re.compile("^Saved missions")).click()
    anna.page.get_by_role("textbox", name="Mission name").fill("round the pit")
    anna.press("Save mission")
    anna.button("Load round the pit").wait_for()
    areas = anna.page.get_by_role("list", name="Forbidden areas").get_by_role("listitem")
    anna.press("Delete area 1")
    areas.wait_for(state="detached")
    anna.page.get_by_text("Areas not on the robot").wait_for(state="detached")
    assert not stage.robot.areas
    anna.press("Undo")
    areas.wait_for()
    assert anna.waypoints.count() == 1
    anna.press("Redo")
    areas.wait_for(state="detached")
    anna.press("Load round the pit")
    areas.wait_for()
    anna.press("Delete round the pit")
    map_of(anna).focus()
    map_of(anna).press("n")
    for _ in range(2):
        map_of(anna).press("Delete")
    anna.page.mouse.click(*within(box, 0.5, 0.2))
    anna.press("Start mission")
    anna.see_state("WALK")
    assert [len(area) for area in stage.robot.areas] == [3]
    names = [command.command for command in stage.robot.commands]
    wanted = [CommandName.SET_AREAS, CommandName.SET_MISSION, CommandName.START_MISSION]
    assert [name for name in names if name in wanted][-3:] == wanted


def test_an_area_drawn_without_control_waits_to_be_sent(visit: Callable[..., Any], stage: Any) -> None:
    anna = visit()
    box = map_of(anna).bounding_box()
    anna.press("Forbid an area")
    for across, down in ((0.6, 0.4), (0.7, 0.4), (0.7, 0.6)):
        anna.page.mouse.click(*within(box, across, down))
    anna.press("Close area")
    anna.page.get_by_text("Areas not on the robot").wait_for()
    assert anna.button("Send areas").is_disabled()
    assert not stage.robot.areas
    anna.take_control()
    anna.press("Send areas")
    anna.page.get_by_text("The robot keeps out of them").wait_for()
    assert [len(area) for area in stage.robot.areas] == [3]


def test_a_mission_is_followed_paused_skipped_and_walked_back(
    visit: Callable[..., Any], stage: Any, picture: Callable[..., None]
) -> None:
    anna, _ = _with_a_waypoint(visit)
    stage.robot.speed = 0.02  # it is still under way when the page has shown it, however busy the computer is
    anna.press("Start mission")
    anna.see_state("WALK")
    anna.page.locator(".mission .reading", has_text="Cross-track error").filter(has_text="0.01").wait_for()
    anna.page.get_by_text("under way, waypoint 1 of 1").wait_for()
    picture(anna, "under-way", anna.part("Mission"))
    anna.press("Pause mission")
    anna.see_state("STAND")
    names = [command.command for command in stage.robot.commands]
    wanted = [CommandName.SET_MISSION, CommandName.START_MISSION, CommandName.PAUSE_MISSION]
    assert [name for name in names if name in wanted] == wanted
    log = anna.page.get_by_role("log", name="Events")
    for button, command in (("Skip waypoint", "skip_waypoint"), ("Return to start", "return_to_start")):
        anna.press(button)
        log.get_by_text(f"{command}: accepted").wait_for()
