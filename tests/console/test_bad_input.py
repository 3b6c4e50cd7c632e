"""What goes wrong between page and robot: the answer is clear, nothing is lost, and the robot is safe.

The robot's own command desk judges; its clock moves only when a test says so.
"""

from __future__ import annotations

import asyncio
import threading
from itertools import pairwise

import msgspec
import pytest
from guarding_desk import GuardedRobot
from running_console import Console, Field, Page

from weaver_console.command_desk import CommandDesk
from weaver_console.page_messages import CommandRequest
from weaver_shared import codec, topics
from weaver_shared.bus import MemoryBus, ZenohBus, free_port
from weaver_shared.messages import CommandName, Heartbeat


@pytest.fixture
def robot(bus: MemoryBus) -> GuardedRobot:
    return GuardedRobot(bus)


def _greeted(page: Page, robot: GuardedRobot) -> Page:
    page.select(robot.wire)
    return page


def test_a_replayed_command_is_refused(console: Console, robot: GuardedRobot, bus: MemoryBus):
    with console.page() as socket:
        page = _greeted(Page(socket), robot)
        page.command(CommandName.TAKE_CONTROL)
        assert page.command(CommandName.STAND)["accepted"]
        assert page.command(CommandName.SIT)["accepted"]
        stand = next(command for command, _ in robot.commands if command.command is CommandName.STAND)
        again = bus.request("weaver", stand)
        assert not again.accepted
        assert "is not newer than" in again.reason
        assert not robot.desk.orders().stand


def test_an_expired_lease_is_told_and_taken_again(console: Console, robot: GuardedRobot):
    with console.page() as socket:
        page = _greeted(Page(socket), robot)
        page.command(CommandName.TAKE_CONTROL)
        robot.clock.forward(seconds=2.1)
        refused = page.command(CommandName.STAND)
        assert (refused["accepted"], refused["reason"]) == (False, "nobody is in control; take control first")
        page.say(type="retain")
        assert page.hear("answer", command="retain_control")["reason"] == "nobody is in control; take control first"
        assert page.command(CommandName.TAKE_CONTROL)["accepted"]
        assert page.command(CommandName.STAND)["accepted"]


def test_two_tabs_of_one_operator_are_two_operators(console: Console, robot: GuardedRobot):
    with console.page() as first, console.page(page="page-0002") as second:
        one, two = _greeted(Page(first), robot), _greeted(Page(second), robot)
        assert one.command(CommandName.TAKE_CONTROL)["accepted"]
        refused = two.command(CommandName.STAND)
        assert (refused["accepted"], refused["reason"]) == (False, "anna is in control")
        assert two.command(CommandName.TAKE_CONTROL, reason="the other tab")["accepted"]
        lost = one.command(CommandName.STAND)
        assert (lost["accepted"], lost["reason"]) == (False, "anna 2 is in control")
        one.say(type="teleop", forward=1.0, left=0.0, turn=0.0, dead_man=True)
        one.say(type="ping", t=1.0)
        one.hear("pong")
        assert not robot.moved
        assert two.command(CommandName.STOP)["accepted"]


class Wall:
    """A computer's clock, ns, that somebody sets."""

    now_ns = 1_700_000_000_000_000_000

    def __call__(self) -> int:
        return self.now_ns


@pytest.mark.parametrize("hours", [-24, 24])
def test_a_clock_that_is_set_costs_no_command(field: Field, hours: int):
    """Sequence numbers rise whatever the console's clock does, under way and over a restart."""
    guarded, wall = GuardedRobot(field.bus), Wall()

    async def session() -> list[bool]:
        accepted = []
        for jump in (0, hours):  # two consoles, the second after the first with another idea of the time
            desk = CommandDesk(field.link, wall_time_ns=wall)
            for name in (CommandName.TAKE_CONTROL, CommandName.STAND, CommandName.SIT, CommandName.STAND):
                reply = await desk.send("anna", "weaver", CommandRequest(id="", command=name))
                accepted.append(reply.answer.accepted)
                wall.now_ns += jump * 3_600_000_000_000
            desk.close()
            wall.now_ns += hours * 3_600_000_000_000
        return accepted

    assert all(asyncio.run(session()))
    numbers = [command.sequence for command, _ in guarded.commands]
    for one_console in (numbers[:4], numbers[4:]):
        assert all(later > earlier for earlier, later in pairwise(one_console))


def test_a_stick_beyond_its_limits_or_not_a_number_is_refused(console: Console, robot: GuardedRobot):
    with console.page() as socket:
        page = _greeted(Page(socket), robot)
        page.command(CommandName.TAKE_CONTROL)
        for forward in ("1.5", "-2", "1e400", '"fast"'):
            socket.send(f'{{"type":"teleop","forward":{forward},"left":0,"turn":0,"dead_man":true}}')
            assert page.hear("error")["reason"]
        assert not robot.moved


def test_a_robot_of_another_schema_is_named_with_what_to_do(field: Field):
    """Its presence can not be read, but it is in the list, and why."""
    newer = codec.SCHEMA_VERSION + 1
    data = msgspec.msgpack.encode([newer, "Heartbeat", 1, 2, "session"])
    with pytest.raises(codec.MessageError) as told:
        codec.decode(data, Heartbeat)
    for _ in range(3):
        field.link._receive_fault("newcomer", str(told.value))
    record = field.link.robot("newcomer")
    assert record is not None
    assert f"schema {newer} is not ours" in record.conflict(field.clock.now_ns())
    assert "update both ends" in record.conflict(field.clock.now_ns())
    assert len([event for event in field.link.events.latest() if event.robot == "newcomer"]) == 1
    field.clock.forward(seconds=6.0)
    assert record.conflict(field.clock.now_ns()) == ""


def test_bytes_that_can_not_be_read_are_a_fault_of_who_sent_them():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    told: list[tuple[str, str]] = []
    came = threading.Event()
    console, robot = ZenohBus(listen=[endpoint]), ZenohBus(connect=[endpoint])
    try:
        console.subscribe("*", topics.HEARTBEAT, lambda *_: None)
        console.hear_faults(lambda robot_id, fault: (told.append((robot_id, fault)), came.set()))
        newer = msgspec.msgpack.encode([codec.SCHEMA_VERSION + 1, "Heartbeat", 1, 2, "session"])
        for _ in range(200):
            robot._session.put("weaver/newcomer/hb", newer)
            if came.wait(0.05):
                break
    finally:
        robot.close()
        console.close()
    assert told[0][0] == "newcomer"
    assert "update both ends" in told[0][1]


@pytest.mark.parametrize("name", ["a" * 300, "a%00b", "%C3%A4" * 200, ".." + "%2F..%2Fetc%2Fpasswd"])
@pytest.mark.parametrize("address", ["/{}", "/api/missions/{}", "/api/rerun/{}/run.rrd", "/api/rerun/weaver/{}"])
def test_names_that_no_file_can_have_are_answered(address: str, name: str, console: Console, robot: GuardedRobot):
    answer = console.http.get(address.format(name))
    assert answer.status_code in (404, 504), answer.text
    assert answer.json()["error"]
