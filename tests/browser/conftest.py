"""One robot at the wire, one console and one browser for all tests of the page; each test has pages of its own."""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from full_robot import FullRobot
from visitors import CHROMIUM, DESK, ROBOT_ID, WITHOUT_WEBGL, Visitor

from weaver_console import built_page
from weaver_console.access import Access
from weaver_console.app import create_app
from weaver_console.hub import Hub
from weaver_console.link import Link
from weaver_console.web_server import web_server
from weaver_shared.bus import MemoryBus
from weaver_shared.quiet_chromium import FLAGS

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
    with running_stage(tmp_path_factory) as shared:
        yield shared


@contextmanager
def running_stage(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
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
    try:
        yield Stage(robot=robot, hub=hub, address=f"http://127.0.0.1:{listener.getsockname()[1]}/")
    finally:
        robot.stop()
        server.should_exit = True
        serving.join()
        listener.close()


@pytest.fixture
def own_stage(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
    """A console for one test alone, which remembers nothing of robots that others had."""
    with running_stage(tmp_path_factory) as own:
        yield own


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
        visitor.wait_for_layout()
        return visitor

    yield visit
    for context in contexts:
        context.close()
    stage.robot.set_back()
    assert not [line for visitor in visitors for line in visitor.complaints]


@pytest.fixture
def picture(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., None]:
    """Keeps what the page, or a part of it, looks like under a name."""
    named = os.environ.get(PICTURES)
    folder = Path(named) if named else tmp_path_factory.getbasetemp() / "pictures"
    folder.mkdir(parents=True, exist_ok=True)

    def keep(visitor: Visitor, name: str, part: Any = None) -> None:
        taken = visitor.page if part is None else part
        taken.screenshot(path=folder / f"{name}.png", timeout=60_000, animations="disabled")

    return keep
