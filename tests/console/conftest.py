"""A bus, a robot at the wire, a built page and consoles for every test that wants one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from running_console import Console, Field
from wire_robot import WireRobot

from weaver_console.access import Role
from weaver_console.event_log import EventLog
from weaver_console.link import Link
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock


@pytest.fixture
def field() -> Iterator[Field]:
    bus, clock = MemoryBus(), SimulatedClock(1_000_000_000)
    link = Link(bus, clock=clock, events=EventLog(lambda: 0.0))
    link.open()
    yield Field(bus=bus, clock=clock, link=link)
    link.close()


@pytest.fixture
def bus() -> MemoryBus:
    return MemoryBus()


@pytest.fixture
def robot(bus: MemoryBus) -> WireRobot:
    return WireRobot(bus)


@pytest.fixture
def page_folder(tmp_path: Path) -> Path:
    folder = tmp_path / "web"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text("<!doctype html><title>Weaver Console</title>")
    (folder / "assets" / "page-1.js").write_text("void 0")
    (tmp_path / "secret.txt").write_text("secret")
    return folder


@pytest.fixture
def console(bus: MemoryBus, page_folder: Path) -> Iterator[Console]:
    console = Console(bus, page_folder)
    yield console
    console.close()


@pytest.fixture
def guarded(bus: MemoryBus, page_folder: Path) -> Iterator[Console]:
    console = Console(bus, page_folder, users={"anna": Role.OPERATOR, "ben": Role.VIEWER, "ada": Role.ADMIN})
    yield console
    console.close()
