"""Two operators at one robot: one asks, the other hands over or declines."""

from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.browser


def test_control_is_asked_for_and_handed_over(
    visit: Callable[..., Any], picture: Callable[..., None], stage: Any
) -> None:
    anna, ben = visit("anna"), visit("ben")
    anna.take_control()
    ben.press("Ask for control")
    request = anna.page.get_by_role("group", name="Request of ben")
    request.wait_for()
    picture(anna, "request-for-control", anna.page.locator(".page > header"))
    request.get_by_role("button", name="Decline").click()
    ben.page.get_by_text("anna keeps control").wait_for()
    assert stage.robot.holder == "anna"
    ben.press("Ask for control")
    request.get_by_role("button", name="Hand over").click()
    ben.button("Release control").wait_for()
    anna.page.get_by_text("ben has control").wait_for()
    assert stage.robot.holder == "ben"
    assert request.count() == 0
