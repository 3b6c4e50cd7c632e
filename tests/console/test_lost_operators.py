"""However an operator is lost while driving, the robot is still within 1.5 s, and says so when the page comes back.

Page and console are real, and the robot's own desk judges; its clock moves only when a test says so.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from guarding_desk import GuardedRobot
from running_console import Console, Page
from websockets.sync.client import ClientConnection

from weaver_shared.bus import MemoryBus
from weaver_shared.config.safety import SafetyLimits
from weaver_shared.messages import CommandName

STILL_WITHIN = 1.5  # s


def closed(socket: ClientConnection, _console: Console) -> None:
    socket.close()


def frozen(_socket: ClientConnection, _console: Console) -> None:
    """A tab put to sleep: the connection stands, and nothing is said. For the robot a dead network looks the same."""


def killed(_socket: ClientConnection, console: Console) -> None:
    console.close()


@pytest.mark.parametrize("lose", [closed, frozen, killed])
def test_a_robot_whose_operator_is_lost_is_still_in_time_and_says_so(
    lose: Callable[[ClientConnection, Console], None], bus: MemoryBus, page_folder: Path
) -> None:
    robot = GuardedRobot(bus)
    console = Console(bus, page_folder)
    with console.page() as socket:
        page = Page(socket)
        page.select(robot.wire)
        page.command(CommandName.TAKE_CONTROL)
        page.say(type="retain")
        page.say(type="teleop", forward=1.0, left=0.0, turn=0.0, dead_man=True)
        page.say(type="ping", t=1.0)
        page.hear("pong")
        driven = robot.desk.orders().teleop_velocity
        assert driven is not None
        assert driven[0] > 0.0
        lose(socket, console)
        robot.clock.forward(seconds=0.4)
        unheld = robot.desk.orders().teleop_velocity
        assert unheld is None or not unheld.any()
        robot.clock.forward(seconds=STILL_WITHIN - 0.4)
        assert robot.desk.orders().operator_silence > SafetyLimits().operator_silence  # for which it holds
        robot.clock.forward(seconds=1.0)
    if lose is not killed:
        console.close()
    again = Console(bus, page_folder)
    with again.page() as socket:
        back = Page(socket)
        back.select(robot.wire)
        refused = back.command(CommandName.STAND)
        assert (refused["accepted"], refused["reason"]) == (False, "nobody is in control; take control first")
        assert back.command(CommandName.TAKE_CONTROL)["accepted"]
        assert robot.desk.orders().teleop_velocity is None or not robot.desk.orders().teleop_velocity.any()
    again.close()
