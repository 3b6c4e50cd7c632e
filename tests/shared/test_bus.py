"""Both buses keep one contract: what a robot's loops rely on holds in memory and over Zenoh alike."""

import contextlib
import queue
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import zenoh

from weaver_shared import topics
from weaver_shared.bus import Bus, MemoryBus, ZenohBus, free_port
from weaver_shared.errors import ConfigurationError, ResourceError
from weaver_shared.messages import Answer, Command, CommandName, Event, Heartbeat, LeaseState, RobotState, Severity

PATIENCE = 10.0  # s, never spent when all is well


@dataclass(frozen=True, slots=True, kw_only=True)
class Ends:
    """Two users of one bus; in memory they are the same object."""

    robot: Bus
    console: Bus


@dataclass(frozen=True, slots=True)
class Inbox:
    """A receiver that hands over what came, in order, to a test that waits for it."""

    received: "queue.Queue[tuple[Any, ...]]"

    def __call__(self, *arguments: Any) -> None:
        self.received.put(arguments)

    def next(self) -> tuple[Any, ...]:
        return self.received.get(timeout=PATIENCE)

    def wait_for(self, wanted: tuple[Any, ...]) -> None:
        while self.next() != wanted:
            pass


@pytest.fixture
def inbox() -> Inbox:
    return Inbox(queue.Queue())


@pytest.fixture(params=["memory", "zenoh"])
def ends(request: pytest.FixtureRequest) -> Iterator[Ends]:
    if request.param == "memory":
        bus = MemoryBus()
        yield Ends(robot=bus, console=bus)
        bus.close()
        return
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    robot = ZenohBus(listen=[endpoint])
    console = ZenohBus(connect=[endpoint])
    yield Ends(robot=robot, console=console)
    console.close()
    robot.close()


def beat(sequence: int) -> Heartbeat:
    return Heartbeat(stamp_ns=1, sequence=sequence, session="a")


def publish_until_heard(bus: Bus, robot_id: str, message: Heartbeat, inbox: Inbox) -> tuple[Any, ...]:
    """A fresh subscription needs a moment to cross the network, and a lost `latest` sample is nobody's fault."""
    for _ in range(round(PATIENCE / 0.05)):
        bus.publish(robot_id, topics.HEARTBEAT, message)
        try:
            return inbox.received.get(timeout=0.05)
        except queue.Empty:
            continue
    raise AssertionError("nothing was heard")


def command(name: CommandName = CommandName.STAND) -> Command:
    return Command(command=name, operator="ada", lease_epoch=1, sequence=1)


def request_when_served(bus: Bus, robot_id: str) -> Answer:
    """Ask until the server is known here: until then a request comes back at once, so tries can not be counted."""
    pause = threading.Event()
    for _ in range(round(PATIENCE / 0.05)):
        try:
            return bus.request(robot_id, command(), timeout=1.0)
        except ResourceError:
            pause.wait(0.05)
    raise AssertionError("nobody answered")


def test_what_is_published_is_received_with_its_robot_and_key(ends: Ends, inbox: Inbox) -> None:
    ends.console.subscribe("w1", topics.HEARTBEAT, inbox)
    assert publish_until_heard(ends.robot, "w1", beat(1), inbox) == ("w1", "hb", beat(1))


def test_a_star_hears_every_robot_and_a_name_only_its_own(ends: Ends, inbox: Inbox) -> None:
    own = Inbox(queue.Queue())
    ends.console.subscribe("*", topics.HEARTBEAT, inbox)
    ends.console.subscribe("w2", topics.HEARTBEAT, own)
    assert publish_until_heard(ends.robot, "w1", beat(1), inbox)[0] == "w1"
    assert publish_until_heard(ends.robot, "w2", beat(2), own) == ("w2", "hb", beat(2))
    inbox.wait_for(("w2", "hb", beat(2)))


def test_order_is_kept_whatever_is_lost(ends: Ends, inbox: Inbox) -> None:
    ends.console.subscribe("w1", topics.HEARTBEAT, inbox)
    publish_until_heard(ends.robot, "w1", beat(0), inbox)
    for sequence in range(1, 200):
        ends.robot.publish("w1", topics.HEARTBEAT, beat(sequence))
    order = [0]
    for _ in range(round(PATIENCE / 0.05)):
        ends.robot.publish("w1", topics.HEARTBEAT, beat(200))
        with contextlib.suppress(queue.Empty):
            while order[-1] != 200:
                order.append(inbox.received.get(timeout=0.05)[2].sequence)
        if order[-1] == 200:
            break
    assert order[-1] == 200
    assert order == sorted(order)


def test_a_late_joiner_gets_the_last_value_of_a_reliable_topic(ends: Ends, inbox: Inbox) -> None:
    for epoch in (1, 2, 3):
        ends.robot.publish("w1", topics.LEASE, LeaseState(holder="ada", epoch=epoch, seconds_left=2.0))
    ends.robot.announce("w1", "walk")
    ends.console.watch(lambda *_: None)
    ends.console.subscribe("*", topics.LEASE, inbox)
    # On a busy computer those before it may be on their way still; what counts is that the last one comes.
    inbox.wait_for(("w1", "state/lease", LeaseState(holder="ada", epoch=3, seconds_left=2.0)))


def test_a_command_is_answered(ends: Ends) -> None:
    def answer(asked: Command) -> Answer:
        return Answer(accepted=asked.command is CommandName.STAND, reason=f"{asked.operator} asked")

    ends.robot.serve("w1", answer)
    assert request_when_served(ends.console, "w1") == Answer(accepted=True, reason="ada asked")
    assert not ends.console.request("w1", command(CommandName.SIT), timeout=PATIENCE).accepted


def test_a_robot_that_is_not_there_does_not_answer(ends: Ends) -> None:
    with pytest.raises(ResourceError, match="'nobody'"):
        ends.console.request("nobody", command(), timeout=0.2)


def test_processes_are_seen_coming_and_going(ends: Ends, inbox: Inbox) -> None:
    ends.console.watch(inbox)
    ends.robot.announce("w1", "walk")
    assert inbox.next() == ("w1", "walk", True)
    ends.robot.close()
    assert inbox.next() == ("w1", "walk", False)


def test_who_was_there_first_is_seen_too(ends: Ends, inbox: Inbox) -> None:
    ends.robot.announce("w1", "vision")
    ends.console.watch(inbox)
    assert inbox.next() == ("w1", "vision", True)


def test_a_robot_id_that_is_no_key_segment_is_refused_on_the_network() -> None:
    bus = ZenohBus()
    try:
        with pytest.raises(ConfigurationError, match="robot id 'a/b' is not valid"):
            bus.publish("a/b", topics.HEARTBEAT, beat(1))
    finally:
        bus.close()


@pytest.fixture
def stranger() -> Iterator[Callable[[str], zenoh.Session]]:
    """Opens sessions that do not speak our format."""
    sessions: list[zenoh.Session] = []

    def open_session(endpoint: str) -> zenoh.Session:
        config = zenoh.Config()
        config.insert_json5("mode", '"peer"')
        config.insert_json5("connect/endpoints", f'["{endpoint}"]')
        config.insert_json5("scouting/multicast/enabled", "false")
        sessions.append(zenoh.open(config))
        return sessions[-1]

    yield open_session
    for session in sessions:
        session.close()  # type: ignore[no-untyped-call]


def answers_when_known(session: zenoh.Session, key: str, payload: bytes) -> list[zenoh.Sample]:
    """Ask until somebody is known to answer there; a session learns of others' queryables a moment later."""
    pause = threading.Event()
    for _ in range(round(PATIENCE / 0.05)):
        replies = [reply.ok for reply in session.get(key, payload=payload, timeout=PATIENCE) if reply.ok]
        if replies:
            return replies
        pause.wait(0.05)
    raise AssertionError("nobody answered")


def test_foreign_bytes_are_dropped_and_the_next_message_still_comes(
    stranger: Callable[[str], zenoh.Session], inbox: Inbox, caplog: pytest.LogCaptureFixture
) -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    bus = ZenohBus(listen=[endpoint])
    try:
        bus.subscribe("w1", topics.HEARTBEAT, inbox)
        session = stranger(endpoint)
        session.put("weaver/w1/hb", b"not a message")
        assert publish_until_heard(bus, "w1", beat(1), inbox) == ("w1", "hb", beat(1))
        bus.serve("w1", lambda _: Answer(accepted=True, reason=""))
        request_when_served(bus, "w1")
        replies = answers_when_known(session, "weaver/w1/cmd", b"\xc1")
        assert len(replies) == 1
        assert b"could not be read" in replies[0].payload.to_bytes()
    finally:
        bus.close()
    assert all("dropped a message on weaver/w1/hb" in record.message for record in caplog.records)


def test_a_taken_port_is_named() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    first = ZenohBus(listen=[endpoint])
    try:
        with pytest.raises(ResourceError, match=f"can not listen on {endpoint}"):
            ZenohBus(listen=[endpoint])
    finally:
        first.close()


def test_publishing_after_closing_is_harmless() -> None:
    bus = ZenohBus()
    bus.close()
    bus.publish("w1", topics.HEARTBEAT, beat(1))


def state_at(stamp_ns: int) -> RobotState:
    three, legs, joints = np.zeros(3), np.zeros(6), np.zeros(30)
    return RobotState(
        stamp_ns=stamp_ns, position_in_world=three, wxyz=np.array([1.0, 0.0, 0.0, 0.0]), velocity_command=three,
        velocity_in_body=three, joint_position=joints, joint_torque=joints, foot_in_body=np.zeros((6, 3)),
        foot_contact=legs > 0.0, foot_force=legs, stability_margin=0.0, roll=0.0, pitch=0.0,
    )  # fmt: skip


def test_states_are_waited_for_one_by_one_until_the_bus_is_closed() -> None:
    """What comes 50 times a second has a thread of its own, which ends with the bus and not before."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    console, robot = ZenohBus(listen=[endpoint], newest_only=True), ZenohBus(connect=[endpoint])
    heard: list[int] = []
    news = threading.Event()

    def hear(_robot: str, _key: str, state: RobotState) -> None:
        heard.append(state.stamp_ns)
        news.set()

    console.subscribe("*", topics.STATE, hear)
    waiting = [thread for thread in threading.enumerate() if thread.name == "bus weaver/*/tele/state"]
    try:
        for stamp_ns in range(1, 200):
            news.clear()
            robot.publish("w1", topics.STATE, state_at(stamp_ns))
            if news.wait(0.1) and len(heard) > 20:
                break
    finally:
        robot.close()
        console.close()
    assert len(heard) > 20
    assert heard == sorted(set(heard))
    assert len(waiting) == 1
    assert not waiting[0].is_alive()


def test_who_wants_only_the_newest_gets_it_and_every_event() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    console, robot = ZenohBus(listen=[endpoint], newest_only=True), ZenohBus(connect=[endpoint])
    beats: list[int] = []
    texts: list[str] = []
    came = threading.Event()
    held = threading.Event()
    complete = threading.Event()

    def look() -> None:
        if "last" in texts and beats[-1] == 1099:
            complete.set()

    def beat(_robot: str, _key: str, heartbeat: Heartbeat) -> None:
        beats.append(heartbeat.sequence)
        came.set()
        held.wait(10.0)  # a console that is short of computing time
        look()

    def say(_robot: str, _key: str, event: Event) -> None:
        texts.append(event.text)
        look()

    console.subscribe("*", topics.HEARTBEAT, beat)
    console.subscribe("*", topics.EVENT, say)
    try:
        for sequence in range(200):
            robot.publish("w1", topics.HEARTBEAT, Heartbeat(stamp_ns=0, sequence=sequence, session="a"))
            if came.wait(0.05):
                break
        first = beats[-1]
        for number in range(100):
            robot.publish("w1", topics.HEARTBEAT, Heartbeat(stamp_ns=0, sequence=1000 + number, session="a"))
            event = Event(stamp_ns=0, severity=Severity.INFO, source="walk", text=str(number))
            robot.publish("w1", topics.EVENT, event)
        for _ in range(200):  # until all of it waits on this side
            robot.publish("w1", topics.EVENT, Event(stamp_ns=0, severity=Severity.INFO, source="walk", text="last"))
            held.set()
            if complete.wait(0.05):
                break
    finally:
        held.set()
        robot.close()
        console.close()
    assert beats[-1] == 1099
    assert beats == sorted(set(beats))
    assert first in beats
    assert len([number for number in beats if number >= 1000]) < 100  # most were overtaken while it was held
    assert [text for text in texts if text != "last"] == [str(number) for number in range(100)]
