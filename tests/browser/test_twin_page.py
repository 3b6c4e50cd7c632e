"""From the simulated robot to the twin and back, both of them running, as an operator does it in a real browser."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from visitors import CHROMIUM, WITHOUT_WEBGL, Visitor

from weaver_shared import topics
from weaver_shared.bus import free_port

pytest.importorskip("pybullet")
pytest.importorskip("playwright.sync_api")

SIMULATED, TWIN = "switched-sim", "switched-twin"
PATIENT = 60_000.0  # ms; two robots on one computer

pytestmark = [
    pytest.mark.realtime,
    pytest.mark.skipif(not CHROMIUM.exists(), reason="Chromium is not installed"),
]


@dataclass(frozen=True, kw_only=True)
class Place:
    address: str
    endpoint: str


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Place]:
    """A console, the simulated robot, the twin's devices and the twin's program, each a process, and nothing else."""
    folder = tmp_path_factory.mktemp("twin")
    port, endpoint = free_port(), f"tcp/127.0.0.1:{free_port()}"
    joined, world, wiring = ["--connect", endpoint], ["--world", "flat"], str(folder / "wiring.toml")
    commands = [
        ["console", "--host", "127.0.0.1", "--port", str(port), "--listen", endpoint],
        ["sim", *world, "--robot-id", SIMULATED, *joined],
        ["twin", "run", *world, "--folder", str(folder), "--robot-id", TWIN, *joined],
        ["robot", "--role", "walk", "--wiring", wiring, "--wait", "120", "--robot-id", TWIN, *joined],
    ]
    environment = {**os.environ, "XDG_DATA_HOME": str(folder)}
    processes = [
        subprocess.Popen([sys.executable, "-m", "weaver_shared.command_line", *one], env=environment)
        for one in commands
    ]
    yield Place(address=f"http://127.0.0.1:{port}/", endpoint=endpoint)
    for process in reversed(processes):
        process.terminate()
    for process in processes:
        process.wait(30.0)


@pytest.fixture
def anna(place: Place, listen: Callable[..., Any], chromium: Callable[..., Any]) -> Iterator[Visitor]:
    context = chromium().new_context(viewport={"width": 1440, "height": 900})
    context.add_init_script("if (window === top) localStorage.setItem('weaver.operator', 'anna')")
    context.add_init_script(WITHOUT_WEBGL)
    visitor = Visitor(context.new_page())
    visitor.page.set_default_timeout(PATIENT)
    for robot in (SIMULATED, TWIN):
        listener = listen(place.endpoint, robot)
        listener.hear(topics.MODE)
        listener.wait_until(lambda newest: newest["state/mode"].mode, 180.0, f"there is no {robot}")
    visitor.page.goto(place.address)
    yield visitor
    context.close()


def pick(visitor: Visitor, robot: str) -> None:
    visitor.page.get_by_role("combobox", name="Robot", exact=True).select_option(robot)


def leave(visitor: Visitor) -> None:
    visitor.press("Release control")
    visitor.button("Take control").wait_for()


def test_an_operator_goes_to_the_twin_and_back_but_not_while_walking(
    place: Place, anna: Visitor, listen: Callable[..., Any]
) -> None:
    robots = {name: listen(place.endpoint, name) for name in (SIMULATED, TWIN)}
    for robot in robots.values():
        robot.hear(topics.MODE)
    pick(anna, SIMULATED)
    anna.page.get_by_text("Simulated robot").wait_for()
    anna.see_state("OFF|SIT|READY")
    anna.stand()
    turn = anna.page.get_by_role("slider", name="Cruise turn to the left")
    for _ in range(5):
        turn.press("ArrowRight")
    anna.see_state("WALK")
    picker = anna.page.get_by_role("combobox", name="Robot", exact=True)
    assert picker.is_disabled()
    assert "pause or stop it first" in picker.get_attribute("title")
    anna.press("Stop cruise")
    anna.see_state("STAND")
    leave(anna)

    pick(anna, TWIN)
    anna.page.get_by_text("Emulated servo bus").wait_for()
    anna.see_state("OFF|SIT|READY")
    anna.stand()
    assert robots[TWIN].newest["state/mode"].mode == "STAND"
    anna.press("Sit")
    anna.see_state("SIT|READY")
    leave(anna)

    pick(anna, SIMULATED)
    anna.page.get_by_text("Simulated robot").wait_for()
    anna.see_state(robots[SIMULATED].newest["state/mode"].mode)
