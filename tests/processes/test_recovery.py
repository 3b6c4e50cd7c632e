"""Killing any one process while the robot walks: the others say so, the robot holds, and the dead one comes back."""

import os
import signal
from collections.abc import Callable
from typing import Any

import pytest

from weaver_shared import topics
from weaver_shared.messages import CommandName, Waypoint
from weaver_shared.operator import Operator

pytest.importorskip("pybullet")

ROBOT_ID = "sim-1"
SAID_WITHIN = 2.0
BACK_WITHIN = 40.0


@pytest.fixture(scope="module")
def product(start_product: Callable[..., Any]) -> Any:
    return start_product("--world", "flat", "--robot-id", ROBOT_ID)


@pytest.fixture
def walking(product: Any, listen: Callable[..., Any]) -> Any:
    """A listener to a robot that is walking a mission under our control."""
    listener = listen(product.endpoint, ROBOT_ID)
    listener.hear(topics.MODE, topics.STATE, topics.ODOMETRY, topics.HEARTBEAT, topics.MISSION)
    listener.wait_until(lambda newest: newest["tele/odometry"].quality == "good", 60.0, "odometry is not good")
    operator = Operator(listener.bus, ROBOT_ID, "tester")
    assert operator.send(CommandName.TAKE_CONTROL, reason="test").accepted
    operator.retain_in_background()
    assert operator.send(CommandName.STAND).accepted
    listener.wait_until(lambda newest: newest["state/mode"].mode in ("STAND", "WALK"), 30.0, "it does not stand")
    there_and_back = (Waypoint(x=1.5, y=0.0), Waypoint(x=0.0, y=0.0)) * 10
    assert operator.send(CommandName.SET_MISSION, waypoints=there_and_back).accepted
    listener.wait_until(lambda _: operator.send(CommandName.START_MISSION).accepted, 30.0, "the mission does not start")
    listener.wait_until(lambda newest: newest["tele/state"].velocity_command[0] > 0.0, 20.0, "it does not walk")
    listener.wait_until(lambda newest: newest["hb"].session, 10.0, "its heart is not heard")
    yield listener
    operator.send(CommandName.PAUSE_MISSION)
    operator.send(CommandName.RELEASE_CONTROL)
    operator.close()


def test_without_vision_the_robot_holds_and_walks_on_when_it_is_back(product: Any, walking: Any) -> None:
    os.kill(product.pids["vision"], signal.SIGKILL)
    walking.wait_until(
        lambda newest: newest["state/mode"].mode == "HOLD" and "vision is silent" in newest["state/mode"].reasons[0],
        SAID_WITHIN,
        "the robot does not hold",
    )
    walking.wait_until(lambda newest: newest["state/mode"].mode == "WALK", BACK_WITHIN, "it does not walk on")


def test_the_robot_walks_on_while_the_console_is_away(product: Any, walking: Any) -> None:
    """Control is held over the bus here, so the console is not the operator's link."""
    before = walking.newest["hb"].session
    os.kill(product.pids["the console"], signal.SIGKILL)
    walking.wait_until(lambda _: any("console" in note for note in product.notes), SAID_WITHIN, "nobody says so")
    assert walking.newest["hb"].session == before
    assert walking.newest["state/mode"].mode == "WALK"


def test_a_killed_robot_process_is_missed_and_comes_back_seated_or_standing(product: Any, walking: Any) -> None:
    before = walking.newest["hb"].session
    os.kill(product.pids["the robot"], signal.SIGKILL)
    walking.wait_until(lambda newest: newest["hb"].session != before, BACK_WITHIN, "the robot does not come back")
    walking.wait_until(lambda newest: newest["state/mode"].mode == "HOLD", 30.0, "it does not stand and hold")
