"""A router with TLS, users and rules: who has no name does not come in, and nobody speaks for somebody else."""

from __future__ import annotations

import json
import queue
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from weaver_console.measuring.guarded_bus import GuardedBus
from weaver_shared import topics
from weaver_shared.bus import ZenohBus, free_port
from weaver_shared.bus_security import PASSWORD, USER, BusRole, BusUser, access_control, own_settings, read_users
from weaver_shared.errors import ConfigurationError, ResourceError
from weaver_shared.messages import Answer, Command, CommandName, Heartbeat, TeleopFrame

PATIENCE = 20.0  # s, never spent when all is well
STICK = TeleopFrame(operator="x", lease_epoch=1, sequence=1, dead_man=True, forward=1.0, left=0.0, turn=0.0)


class Guarded:
    """A router, and whoever comes in by a name."""

    def __init__(self, folder: Path, endpoint: str) -> None:
        self.bus = GuardedBus(folder, robots={"first": ["w1"], "second": ["w2"]})
        self.endpoint = endpoint
        self.opened: list[ZenohBus] = []

    def enter(self, name: str, *, patience: float = PATIENCE, **changes: str) -> ZenohBus:
        settings = own_settings({**self.bus.environment(name), **changes}) | {
            "connect/timeout_ms": round(1e3 * patience)
        }
        self.opened.append(ZenohBus(connect=[self.endpoint], settings=settings))
        return self.opened[-1]


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    if shutil.which("openssl") is None:
        pytest.skip("openssl is not installed")
    guarded = Guarded(tmp_path_factory.mktemp("bus"), f"tls/127.0.0.1:{free_port()}")
    command = [sys.executable, "-m", "weaver_shared.command_line", "router", "--listen", guarded.endpoint]
    with subprocess.Popen([*command, *guarded.bus.router_options], stdout=subprocess.PIPE, text=True) as router:
        assert router.stdout is not None
        assert "the bus meets" in router.stdout.readline()
        yield guarded
        for bus in guarded.opened:
            bus.close()
        router.terminate()


def _listens(bus: ZenohBus, topic: topics.Topic) -> queue.Queue[tuple[str, Any]]:
    heard: queue.Queue[tuple[str, Any]] = queue.Queue()
    bus.subscribe("*", topic, lambda robot_id, _key, message: heard.put((robot_id, message)))
    return heard


def _says_until_heard(robot: ZenohBus, robot_id: str, heard: queue.Queue[tuple[str, Any]]) -> str:
    for sequence in range(round(PATIENCE / 0.05)):
        robot.publish(robot_id, topics.HEARTBEAT, Heartbeat(stamp_ns=0, sequence=sequence, session="a"))
        try:
            return heard.get(timeout=0.05)[0]
        except queue.Empty:
            continue
    raise AssertionError(f"{robot_id} was not heard")


def test_each_does_what_its_role_may_and_no_more(guarded: Guarded) -> None:
    robot, console, viewer = (guarded.enter(name) for name in ("first", "console", "viewer"))
    obeyed: list[CommandName] = []

    def answer(command: Command) -> Answer:
        obeyed.append(command.command)
        return Answer(accepted=True, reason="")

    robot.serve("w1", answer)
    driven = _listens(robot, topics.TELEOP)
    watched, shown = _listens(console, topics.HEARTBEAT), _listens(viewer, topics.HEARTBEAT)
    assert _says_until_heard(robot, "w1", watched) == "w1"
    assert _says_until_heard(robot, "w1", shown) == "w1"
    stop = Command(command=CommandName.STOP, operator="x", lease_epoch=0, sequence=1)
    for _ in range(100):  # the router tells the console of the robot's desk a moment later
        try:
            assert console.request("w1", stop).accepted
        except ResourceError:
            continue
        break
    assert obeyed == [CommandName.STOP]
    with pytest.raises(ResourceError):
        viewer.request("w1", stop, timeout=0.5)
    viewer.publish("w1", topics.TELEOP, STICK)
    assert obeyed == [CommandName.STOP]
    assert driven.empty()
    # A robot's computer speaks for its own robot alone: what it says for another is dropped on the way.
    second = guarded.enter("second")
    second.publish("w1", topics.HEARTBEAT, Heartbeat(stamp_ns=0, sequence=-1, session="impostor"))
    assert _says_until_heard(second, "w2", shown) in ("w1", "w2")
    assert not any(message.session == "impostor" for _, message in list(watched.queue) + list(shown.queue))


def test_a_wrong_password_stays_outside(guarded: Guarded) -> None:
    for changes in ({PASSWORD: "guessed at random"}, {USER: "nobody"}):
        with pytest.raises(ResourceError, match="does not let"):
            guarded.enter("first", patience=1.0, **changes)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{", "Invalid JSON"),
        ("{}", "names nobody"),
        ('{"a": {"password": "longenough", "role": "king"}}', "a.role"),
        ('{"a": {"password": "short", "role": "viewer"}}', "a.password"),
        ('{"a": {"password": "with:colon", "role": "viewer"}}', "a.password"),
        ('{"a": {"password": "longenough", "role": "robot", "robots": ["**"]}}', "a.robots.0"),
    ],
)
def test_a_users_file_that_is_not_valid_is_refused_with_the_place(tmp_path: Path, text: str, told: str) -> None:
    file = tmp_path / "users.json"
    file.write_text(text)
    with pytest.raises(ConfigurationError, match=told):
        read_users(file)


def test_a_name_without_password_is_a_mistake_that_is_told() -> None:
    with pytest.raises(ConfigurationError, match=PASSWORD):
        own_settings({"WEAVER_BUS_USER": "first"})
    assert own_settings({}) == {}


def test_viewers_are_never_let_ask_or_steer() -> None:
    rules = access_control({"wall": BusUser(password="longenough", role=BusRole.VIEWER)})
    assert json.dumps(rules["policies"]) == json.dumps([{"rules": ["hears", "listens", "looks"], "subjects": ["wall"]}])
    assert rules["default_permission"] == "deny"
