"""People at pages: what they press, see and wait for."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

CHROMIUM = Path("/usr/bin/chromium")
ROBOT_ID = "weaver-1"
PATIENT = 20_000.0  # ms
DESK, PHONE = (1440, 900), (390, 844)

LAID_OUT = """
() => {
  const box = JSON.stringify(document.querySelector("[role=application][aria-label=Map]")?.getBoundingClientRect());
  const before = window.boxOfMap ?? { box: undefined, frames: 0 };
  window.boxOfMap = { box, frames: box !== undefined && box === before.box ? before.frames + 1 : 0 };
  return window.boxOfMap.frames >= 15 && document.querySelector(".legend") !== null;
}
"""
"""Whether the ground has come and the map has kept its place for some frames: a hand waits for that too."""

WITHOUT_WEBGL = """
const original = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.startsWith("webgl") ? null : original.call(this, kind, ...rest);
};
"""


@dataclass
class Visitor:
    """A person at a page."""

    page: Any
    requested: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.page.set_default_timeout(PATIENT)
        self.page.on("request", lambda request: self.requested.append(request.url))
        self.page.on("websocket", lambda websocket: self.requested.append(websocket.url))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))

    def wait_for_layout(self) -> None:
        self.page.wait_for_function(LAID_OUT)

    def button(self, name: str | re.Pattern[str]) -> Any:
        return self.page.get_by_role("button", name=name, exact=isinstance(name, str))

    def press(self, name: str | re.Pattern[str]) -> None:
        self.button(name).click()

    def part(self, name: str) -> Any:
        """A titled part of the page."""
        return self.page.locator("section.panel").filter(has=self.page.get_by_role("heading", name=name, exact=True))

    def take_control(self) -> None:
        self.press("Take control")
        self.button("Release control").wait_for()

    def stand(self) -> None:
        self.take_control()
        self.press("Stand")
        self.see_state("STAND")

    def see_state(self, state: str) -> None:
        """Wait until the robot is shown in one of the states, a pattern."""
        self.page.get_by_role("status", name="Robot status").filter(has_text=re.compile(state)).wait_for()

    @property
    def waypoints(self) -> Any:
        return self.page.get_by_role("list", name="Waypoints").get_by_role("listitem")


def map_of(visitor: Visitor) -> Any:
    return visitor.page.get_by_role("application", name="Map", exact=True)


def within(box: dict[str, float], across: float, down: float) -> tuple[float, float]:
    """A place within a box, by shares of its width and height."""
    return box["x"] + across * box["width"], box["y"] + down * box["height"]
