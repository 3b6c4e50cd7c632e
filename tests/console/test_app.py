"""The console as a page meets it: over HTTP and WebSocket, with a robot at the other end of the bus."""

from __future__ import annotations

import http.client
from typing import Any

import pytest
from running_console import Console, Page
from websockets.exceptions import ConnectionClosed, InvalidStatus
from wire_robot import WireRobot

from weaver_console import built_page
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.messages import CommandName


def test_the_page_is_served_with_a_policy_that_lets_nothing_else_in(console: Console):
    answer = console.http.get("/")
    assert answer.status_code == 200
    policy = dict(part.strip().split(" ", 1) for part in answer.headers["content-security-policy"].split(";"))
    assert policy["default-src"] == "'self'"
    assert policy["connect-src"] == "'self'"
    assert policy["frame-ancestors"] == "'self'"
    assert "script-src" not in policy
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert "immutable" in console.http.get("/assets/page-1.js").headers["cache-control"]


@pytest.mark.parametrize("path", ["/../secret.txt", "/%2e%2e/secret.txt", "/assets/../../secret.txt", "/none.html"])
def test_nothing_outside_the_page_is_served(console: Console, path: str):
    connection = http.client.HTTPConnection("127.0.0.1", console.port, timeout=5.0)
    connection.request("GET", path)
    answer = connection.getresponse()
    assert answer.status == 404
    assert b"secret" not in answer.read()
    connection.close()


def test_without_a_build_the_console_says_what_to_do(bus: MemoryBus, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(built_page, "page_folder", lambda: None)
    console = Console(bus, None)
    answer = console.http.get("/")
    console.close()
    assert answer.status_code == 503
    assert "The page is not built" in answer.text
    assert "npm run build" in answer.text


def test_health_and_robots_can_be_read(console: Console, robot: WireRobot):
    for _ in range(6):
        robot.step()
    assert console.http.get("/api/health").json()["status"] == "ok"
    (entry,) = console.http.get("/api/robots").json()["robots"]
    assert (entry["id"], entry["kind"]) == ("weaver", "SIM")


def test_a_request_from_another_site_is_refused(console: Console):
    assert console.http.get("/api/robots", headers={"origin": "http://evil.example"}).status_code == 403
    assert console.http.get("/api/robots", headers={"host": "evil.example"}).status_code == 403
    with pytest.raises(InvalidStatus):
        console.page(origin="http://evil.example")
    with pytest.raises(InvalidStatus):
        console.connect("/viser/page-0001/", origin="http://evil.example")


def test_a_page_takes_control_stands_and_sends_a_mission(console: Console, robot: WireRobot):
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        assert page.command(CommandName.TAKE_CONTROL)["accepted"]
        assert page.command(CommandName.STAND)["accepted"]
        assert page.command(CommandName.SET_MISSION, waypoints=[{"x": 1.0, "y": 2.0}])["accepted"]
        answer = page.command(CommandName.SET_OVERRIDE, name="virtual_stiffness", value=900.0, seconds=60.0)
        assert answer["applied_value"] == 900.0
        assert answer["round_trip_s"] >= 0.0
    assert robot.waypoints[0].x == 1.0
    sequences = [command.sequence for command in robot.commands]
    assert sequences == sorted(set(sequences))
    assert {command.lease_epoch for command in robot.commands[1:]} == {1}


def test_a_command_without_control_is_refused(console: Console, robot: WireRobot):
    with console.page() as socket:
        page = Page(socket)
        page.hear("hello")
        page.say(type="command", id="early", command="stand")
        assert page.hear("answer", id="early")["reason"] == "no robot is selected"
        for _ in range(6):
            robot.step()
        page.say(type="select", robot="weaver")
        answer = page.command(CommandName.STAND)
        assert (answer["accepted"], answer["applied_value"]) == (False, None)
        assert answer["reason"] == "nobody controls this robot; take control first"
    assert robot.mode == "SIT"


def test_a_second_page_watches_may_not_command_and_may_stop(console: Console, robot: WireRobot):
    with console.page() as first, console.page("page-0002", "anna") as second:
        anna, other = Page(first), Page(second)
        anna.select(robot)
        assert anna.command(CommandName.TAKE_CONTROL)["accepted"]
        assert other.hear("hello")["operator"] == "anna 2"
        other.say(type="select", robot="weaver")
        other.hear("value", key="tele/state")
        refused = other.command(CommandName.STAND)
        assert (refused["accepted"], refused["reason"]) == (False, "anna controls this robot")
        assert other.command(CommandName.STOP)["accepted"]
    assert robot.stopped


def test_control_is_retained_by_the_page_and_a_refusal_is_told_once(console: Console, robot: WireRobot):
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        page.say(type="retain")
        assert page.hear("answer", id=None)["command"] == "retain_control"
        page.say(type="retain")
        page.command(CommandName.TAKE_CONTROL)
        page.say(type="retain")
        page.say(type="ping", t=4.5)
        assert page.hear("pong")["t"] == 4.5
        page.command(CommandName.STAND)
    names = [command.command for command in robot.commands]
    assert names.count(CommandName.RETAIN_CONTROL) == 3


def test_what_is_no_message_is_answered_and_the_page_stays(console: Console, robot: WireRobot):
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        for bad in ("", "{", "null", '{"type":"fly"}', '{"type":"select"}', "[" * 100_000):
            socket.send(bad)
            assert page.hear("error")["reason"]
        socket.send(b"\x00\xff")
        assert "understood" in page.hear("error")["reason"]
        page.say(type="layer", name="gold")
        assert "elevation, roughness, step_height, uncertainty, age" in page.hear("error")["reason"]
        page.say(type="select", robot="ghost")
        assert "known are weaver" in page.hear("error")["reason"]
        page.say(type="teleop", forward=2.0, left=0.0, turn=0.0, dead_man=True)
        assert "-1 to 1" in page.hear("error")["reason"]
        assert page.command(CommandName.STOP)["accepted"]


def test_an_oversized_frame_ends_the_connection_and_nothing_else(console: Console, robot: WireRobot):
    with console.page() as socket:
        socket.send("x" * 300_000)
        with pytest.raises(ConnectionClosed) as closed:
            Page(socket).hear("never")
    assert closed.value.rcvd.code == 1009
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        assert page.command(CommandName.STOP)["accepted"]


def test_a_robot_that_does_not_answer_is_a_refusal_that_says_so(console: Console, robot: WireRobot, bus: MemoryBus):
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        bus._servers.clear()
        answer = page.command(CommandName.STOP)
        assert not answer["accepted"]
        assert "no robot 'weaver'" in answer["reason"]
        assert "stop did not reach weaver" in page.hear("event", severity="error")["text"]


def test_the_same_page_connecting_again_replaces_itself(console: Console, robot: WireRobot):
    with console.page() as first:
        Page(first).hear("hello")
        with console.page() as second:
            assert Page(second).hear("hello")["operator"] == "anna"
            first.send('{"type":"retain"}')
            with pytest.raises(ConnectionClosed) as closed:
                Page(first).hear("never")
            assert closed.value.rcvd.code == 4000
            assert console.http.get("/api/health").json()["pages"] == 1


@pytest.mark.parametrize("query", ["page=x", "page=", "page=page%200001", "page=page-0001&operator=%00"])
def test_a_connection_without_a_proper_name_is_closed(console: Console, query: str):
    with console.connect(f"/ws?{query}") as socket, pytest.raises(ConnectionClosed, match="letters, digits"):
        socket.recv(timeout=5.0)


def test_a_walking_robot_is_not_left_behind_and_a_standing_one_is_released(console: Console, bus: MemoryBus):
    robot, other = WireRobot(bus, "walker"), WireRobot(bus, "second")
    other.step()
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        page.command(CommandName.TAKE_CONTROL)
        robot.mode = "WALK"
        robot.waypoints = ()
        for _ in range(5):
            robot.step(0.0)
            robot.mode = "WALK"
        robot._publish_slow(robot.tick)
        page.say(type="select", robot="second")
        assert "is walking under your control" in page.hear("error")["reason"]
        robot.mode = "STAND"
        robot._publish_slow(robot.tick)
        page.say(type="select", robot="second")
        page.hear("selected", robot="second")
        page.say(type="command", id="s", command="stop")
        assert {page.hear("answer")["command"] for _ in range(2)} == {"release_control", "stop"}
    assert robot.holder == ""
    assert other.stopped
    assert not robot.stopped


def test_a_stop_may_go_to_a_robot_that_is_not_selected_and_nothing_else_may(console: Console, bus: MemoryBus):
    robot, other = WireRobot(bus, "near"), WireRobot(bus, "far")
    other.step()
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        assert not page.command(CommandName.STAND, robot="far")["accepted"]
        assert page.command(CommandName.STOP, robot="far")["accepted"]
        assert not page.command(CommandName.STOP, robot="nowhere")["accepted"]
    assert other.stopped
    assert not robot.stopped


def test_teleoperation_reaches_the_robot_with_rising_numbers(console: Console, robot: WireRobot, bus: MemoryBus):
    frames: list[Any] = []
    bus.subscribe("weaver", topics.TELEOP, lambda robot_id, key, frame: frames.append(frame))
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        page.command(CommandName.TAKE_CONTROL)
        for dead_man in (True, True, False):
            page.say(type="teleop", forward=0.5, left=-1.0, turn=0.0, dead_man=dead_man)
        page.say(type="ping", t=1.0)
        page.hear("pong")
    assert [frame.dead_man for frame in frames] == [True, True, False]
    assert (frames[0].operator, frames[0].lease_epoch, frames[0].left) == ("anna", 1, -1.0)
    assert frames[0].sequence < frames[1].sequence < frames[2].sequence
