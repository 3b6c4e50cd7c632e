"""One robot at the wire, one console and one browser for all tests of the page; each test has pages of its own."""

from __future__ import annotations

import os
import re
import socket
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from full_robot import FullRobot

from weaver_console import built_page
from weaver_console.access import Access
from weaver_console.app import create_app
from weaver_console.hub import Hub
from weaver_console.link import Link
from weaver_console.web_server import web_server
from weaver_shared.bus import MemoryBus

CHROMIUM = Path("/usr/bin/chromium")
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
ROBOT_ID = "weaver-1"
PATIENT = 20_000.0  # ms
DESK, PHONE = (1440, 900), (390, 844)

PICTURES = "WEAVER_PICTURES"
"""Environment variable with the folder for the guide's pictures; without it they are kept beside the test's files."""


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    """Yields a function that starts a browser with further flags; the one without any is shared."""
    playwright = pytest.importorskip("playwright.sync_api")
    if not CHROMIUM.exists():
        pytest.skip("Chromium is not installed")
    if built_page.page_folder() is None:
        pytest.skip("the page is not built")
    with playwright.sync_playwright() as machine:
        started: dict[tuple[str, ...], Any] = {}

        def start(*flags: str) -> Any:
            if flags not in started:
                started[flags] = machine.chromium.launch(executable_path=str(CHROMIUM), args=[*FLAGS, *flags])
            return started[flags]

        yield start
        for browser in started.values():
            browser.close()


@dataclass(kw_only=True)
class Stage:
    """A console with a robot, both in this process."""

    robot: FullRobot
    hub: Hub
    address: str


@pytest.fixture(scope="session")
def stage(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
    bus = MemoryBus()
    hub = Hub(Link(bus))
    robot = FullRobot(bus, ROBOT_ID, tmp_path_factory.mktemp("recordings"))
    listener = socket.create_server(("127.0.0.1", 0))
    data = tmp_path_factory.mktemp("data")
    server = web_server(create_app(hub, Access(host="127.0.0.1"), data=data))
    serving = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
    serving.start()
    while not server.started:
        time.sleep(0.005)
    robot.start()
    yield Stage(robot=robot, hub=hub, address=f"http://127.0.0.1:{listener.getsockname()[1]}/")
    robot.stop()
    server.should_exit = True
    serving.join()
    listener.close()


@dataclass
class Visitor:
    """A person at a page."""

    page: Any
    requested: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.page.set_default_timeout(PATIENT)
        self.page.on("request", lambda request: self.requested.append(request.url))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))

    def button(self, name: str | re.Pattern[str]) -> Any:
        return self.page.get_by_role("button", name=name, exact=isinstance(name, str))

    def press(self, name: str | re.Pattern[str]) -> None:
        self.button(name).click()

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


@pytest.fixture
def visit(chromium: Callable[..., Any], stage: Stage) -> Iterator[Callable[..., Visitor]]:
    """Opens a page; all are closed, and the robot is set back, after the test."""
    contexts: list[Any] = []
    visitors: list[Visitor] = []

    def visit(
        name: str = "anna", *, size: tuple[int, int] = DESK, flags: tuple[str, ...] = (), scene: bool = False,
        **settings: Any,
    ) -> Visitor:  # fmt: skip
        context = chromium(*flags).new_context(
            viewport={"width": size[0], "height": size[1]}, **{"color_scheme": "light", **settings}
        )
        contexts.append(context)
        context.add_init_script(f"if (window === top) localStorage.setItem('weaver.operator', '{name}')")
        if not scene:
            context.add_init_script(WITHOUT_WEBGL)
        visitor = Visitor(context.new_page())
        visitors.append(visitor)
        visitor.page.goto(stage.address)
        visitor.see_state("HOLD|STAND|SIT|ESTOP|WALK")
        return visitor

    yield visit
    for context in contexts:
        context.close()
    stage.robot.set_back()
    assert not [line for visitor in visitors for line in visitor.complaints]


WITHOUT_WEBGL = """
const original = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.startsWith("webgl") ? null : original.call(this, kind, ...rest);
};
"""


@pytest.fixture
def picture(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Visitor, str], None]:
    """Keeps what the page looks like under a name."""
    named = os.environ.get(PICTURES)
    folder = Path(named) if named else tmp_path_factory.getbasetemp() / "pictures"
    folder.mkdir(parents=True, exist_ok=True)
    return lambda visitor, name: visitor.page.screenshot(path=folder / f"{name}.png", timeout=60_000)
