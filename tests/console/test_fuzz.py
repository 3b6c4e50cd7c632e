"""Anything at all over REST and WebSocket: nothing breaks, and no command is carried out without control.

WEAVER_FUZZ=2000 tries so many of each instead of the few that every run of the tests does.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
from guarding_desk import GuardedRobot
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from running_console import PASSWORD, Console, Page

from weaver_console.access import Access, Role
from weaver_console.app import create_app
from weaver_console.hub import Hub
from weaver_console.link import Link
from weaver_shared.bus import MemoryBus
from weaver_shared.messages import CommandName

COUNT = int(os.environ.get("WEAVER_FUZZ", "4"))
LITTLE = settings(
    max_examples=COUNT,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.filter_too_much],
)
SCHEMA = schemathesis.openapi.from_dict(
    create_app(Hub(Link(MemoryBus()), scenes=False), Access(host="127.0.0.1")).openapi()
)


@pytest.fixture(scope="module")
def bus() -> MemoryBus:
    return MemoryBus()


@pytest.fixture(scope="module")
def robot(bus: MemoryBus) -> GuardedRobot:
    return GuardedRobot(bus)


@pytest.fixture(scope="module")
def console(bus: MemoryBus, robot: GuardedRobot) -> Iterator[Console]:
    console = Console(bus, None)
    yield console
    console.close()


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Console]:
    console = Console(MemoryBus(), None, users={"anna": Role.OPERATOR})
    yield console
    console.close()


@SCHEMA.parametrize()
@LITTLE
def test_no_request_breaks_the_console(case: Any, console: Console) -> None:
    answer = case.call(base_url=str(console.http.base_url))
    # No page built, no robot to fetch from, no room on the disk: answers of ours, with a sentence, and no breakdown.
    deliberate = answer.status_code in (503, 504, 507) and answer.json()["error"]
    assert answer.status_code < 500 or deliberate, answer.text
    assert "Traceback" not in answer.text


@SCHEMA.parametrize()
@LITTLE
def test_no_request_is_served_without_a_login(case: Any, guarded: Console) -> None:
    path = case.operation.path
    answer = case.call(base_url=str(guarded.http.base_url))
    if path in ("/api/health", "/api/login"):
        assert answer.status_code < 500
    else:
        assert answer.status_code in (401, 403, 404, 405, 413), answer.text
    assert PASSWORD not in answer.text


ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**70), 2**70) | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)
KINDS = (
    "select", "command", "retain", "teleop", "draft", "layer", "view", "watch", "ping", "taken", "ask_for_control",
    "answer_request", "nothing",
)  # fmt: skip
FIELDS = {
    "robot": st.just("weaver") | ANYTHING,
    "id": st.text(max_size=8) | ANYTHING,
    # Without taking control: whatever else is asked for must not be done.
    "command": st.sampled_from([name.value for name in CommandName if name is not CommandName.TAKE_CONTROL]) | ANYTHING,
    "name": st.text(max_size=12) | ANYTHING,
    "value": st.floats() | ANYTHING,
    "seconds": st.floats() | ANYTHING,
    "reason": st.text(max_size=12) | ANYTHING,
    "waypoints": st.lists(st.fixed_dictionaries({"x": st.floats(), "y": st.floats()}), max_size=4) | ANYTHING,
    "forward": st.floats(-1, 1) | ANYTHING,
    "left": st.floats(-1, 1) | ANYTHING,
    "turn": st.floats(-1, 1) | ANYTHING,
    "dead_man": st.booleans() | ANYTHING,
    "cameras": st.booleans() | ANYTHING,
    "t": st.floats() | ANYTHING,
    "asker": st.just("anna") | ANYTHING,
    "grant": st.booleans() | ANYTHING,
}
MESSAGE = st.fixed_dictionaries({"type": st.sampled_from(KINDS)}, optional=FIELDS)
FRAME = MESSAGE.map(json.dumps) | ANYTHING.map(json.dumps) | st.text(max_size=40) | st.binary(max_size=40)


@LITTLE
@given(frames=st.lists(FRAME, min_size=5, max_size=25))
def test_no_frame_breaks_the_page_or_moves_a_robot_without_control(
    frames: list[str | bytes], console: Console, robot: GuardedRobot
) -> None:
    with console.page() as socket:
        page = Page(socket)
        page.select(robot.wire)
        before = len(robot.commands)
        for frame in frames:
            socket.send(frame)
        page.say(type="ping", t=4711.0)
        page.hear("pong", t=4711.0)
        page.command(CommandName.STOP)
    assert not robot.moved
    carried_out = {command.command for command, answer in robot.commands[before:] if answer.accepted}
    assert carried_out <= {CommandName.STOP}
