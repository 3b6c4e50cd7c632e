"""A recording made, replayed and gone about in on the page."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.browser


def test_a_recording_is_made_replayed_wound_and_left(
    visit: Callable[..., Any], stage: Any, picture: Callable[..., None]
) -> None:
    anna = visit("anna")
    anna.press("Start recording")
    anna.page.get_by_role("status", name="Recording now").wait_for()
    anna.page.wait_for_timeout(1500)
    anna.stand()
    anna.page.wait_for_timeout(1500)
    anna.press("Stop recording")
    anna.button(re.compile("^Replay weaver-1_")).wait_for()
    picture(anna, "recordings", anna.part("Recording"))
    rerun = anna.page.get_by_role("link", name=re.compile("^Open weaver-1_.*mcap in Rerun$"))
    assert rerun.get_attribute("href").startswith("/rerun/?url=http")
    anna.press(re.compile("^Replay weaver-1_"))
    banner = anna.page.get_by_text("REPLAY of a recording")
    banner.wait_for()
    timeline = anna.page.get_by_role("slider", name="Timeline")
    anna.press("Pause replay")
    anna.button("Play").wait_for()
    timeline.fill("0.1")
    anna.see_state("SIT")
    anna.press("Next event")
    timeline.fill(timeline.get_attribute("max"))
    anna.see_state("STAND")
    assert anna.button("Stand").is_disabled()
    anna.page.get_by_text("anna had control").wait_for()
    assert anna.button("Take control").count() == 0
    anna.page.wait_for_timeout(1500)
    assert anna.page.get_by_role("status", name="Robot status").get_attribute("data-tone") != "stale"
    picture(anna, "replay")
    anna.press("End replay")
    banner.wait_for(state="hidden")
    anna.page.get_by_text("Simulated robot").wait_for()
    anna.page.get_by_role("log", name="Events").get_by_text("the replay has ended").wait_for()
    assert anna.page.get_by_role("log", name="Events").get_by_text("is lost").count() == 0
