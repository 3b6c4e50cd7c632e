"""What holds for every test, and fixtures of those that run the whole product as processes.

Property tests take the same examples each time and have no deadline that a slow computer could miss.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

from weaver_shared.bus import ZenohBus, free_port

settings.register_profile("deterministic", derandomize=True, deadline=None, database=None)
settings.load_profile("deterministic")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Whoever starts the product keeps real time and has the computer for itself; long walks begin the others."""
    for item in items:
        if "start_product" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.realtime)
        if "walks" in item.path.parts:
            item.add_marker(pytest.mark.walk)
    items.sort(key=lambda item: item.get_closest_marker("walk") is None)


@dataclass(frozen=True)
class Product:
    """A running `weaver up`: where its page and its bus are, and which process is which."""

    address: str
    endpoint: str
    pids: dict[str, int]
    notes: list[str]  # what the supervisor has said


@pytest.fixture(scope="module")
def start_product(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., Product]]:
    """Starts `weaver up` with the given options; ended, with all it started, after the module's tests."""
    data = tmp_path_factory.mktemp("data")
    with contextlib.ExitStack() as stack:
        yield lambda *options: stack.enter_context(_running(data, *options))


@contextlib.contextmanager
def _running(data: Path, *options: str) -> Iterator[Product]:
    port = free_port()
    command = [sys.executable, "-m", "weaver_shared.command_line", "up", "--no-browser", "--port", str(port), *options]
    environment = {**os.environ, "XDG_DATA_HOME": str(data)}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
    assert process.stdout is not None
    assert process.stderr is not None
    try:
        described = json.loads(process.stderr.readline())
        notes: list[str] = []
        reader = threading.Thread(target=_collect, args=(process.stderr, notes), daemon=True)
        reader.start()
        assert "http://" in process.stdout.readline()
        yield Product(f"http://127.0.0.1:{port}/", described["bus"], described["pids"], notes)
    finally:
        process.terminate()
        process.wait(15.0)
        reader.join(5.0)
        process.stdout.close()
        process.stderr.close()


def _collect(stream: Any, notes: list[str]) -> None:
    notes.extend(line.rstrip() for line in stream)


class Listener:
    """Remembers the newest message of each topic and lets a test wait for a condition on them."""

    def __init__(self, endpoint: str, robot_id: str = "*") -> None:
        self.bus = ZenohBus(connect=[endpoint])
        self.robot_id = robot_id
        self.newest: dict[str, Any] = {}
        self._changed = threading.Condition()

    def hear(self, *listened: Any) -> None:
        for topic in listened:
            self.bus.subscribe(self.robot_id, topic, self._receive)

    def wait_until(self, condition: Callable[[dict[str, Any]], object], timeout: float, what: str) -> None:
        """Return as soon as the condition on {key: message} holds; fail with `what` after `timeout` s."""
        with self._changed:
            assert self._changed.wait_for(lambda: _holds(condition, self.newest), timeout), (
                f"{what} within {timeout} s; last heard {self.newest.get('state/mode')}"
            )

    def _receive(self, _robot_id: str, key: str, message: Any) -> None:
        with self._changed:
            self.newest[key] = message
            self._changed.notify_all()


def _holds(condition: Callable[[dict[str, Any]], object], newest: dict[str, Any]) -> bool:
    try:
        return bool(condition(newest))
    except KeyError:
        return False


@pytest.fixture
def listen() -> Iterator[Callable[..., Listener]]:
    """Makes listeners on a product's bus."""
    made: list[Listener] = []

    def make(endpoint: str, robot_id: str = "*") -> Listener:
        made.append(Listener(endpoint, robot_id))
        return made[-1]

    yield make
    for listener in made:
        listener.bus.close()
