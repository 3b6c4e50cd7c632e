"""Robots come, go and return at the console by themselves."""

import pytest
from running_console import Field

from weaver_console.roster import Roster, describe
from weaver_shared import topics
from weaver_shared.messages import Heartbeat, Presence
from weaver_shared.robots import load_robot


def _texts(field: Field) -> list[str]:
    return [event.text for event in field.link.events.latest()]


def test_a_robot_appears_by_itself_with_its_kind(field: Field):
    field.forward(field.robot("hexa-2", kind="EMULATED BUS"), 0.2)
    (record,) = field.link.robots()
    entry = describe(record, field.clock.now_ns())
    assert (entry["id"], entry["kind"], entry["alive"], entry["world"]) == ("hexa-2", "EMULATED BUS", True, "flat")
    assert entry["leg_names"] == ["AR", "BR", "CR", "CL", "BL", "AL"]
    assert len(entry["joint_names"]) == len(entry["joint_limits"]) == 30
    assert "hexa-2 is connected" in _texts(field)


def test_what_may_be_asked_of_body_and_legs_is_in_the_list(field: Field):
    field.forward(field.robot("hexa-2"), 0.2)
    (record,) = field.link.robots()
    motion = describe(record, field.clock.now_ns())["motion"]
    assert motion["largest_pose"] == [0.06, 0.06, 0.05, 0.25, 0.25, 0.3]
    assert motion["largest_cruise"] == [0.25, 0.1, 0.5]
    assert motion["postures"] == []
    record.description = load_robot("bullet_b_mammalian")
    assert describe(record, field.clock.now_ns())["motion"]["postures"] == ["mammalian", "insectoid"]


def test_a_second_of_silence_is_a_loss_and_the_next_heartbeat_a_return(field: Field):
    robot = field.robot()
    field.forward(robot, 0.2)
    field.clock.forward(seconds=0.9)
    field.link.check()
    assert field.link.robot("weaver").alive
    field.clock.forward(seconds=0.2)
    field.link.check()
    assert not field.link.robot("weaver").alive
    assert _texts(field)[-1] == "weaver is lost: no heartbeat for 1 s"
    field.forward(robot, 0.1)
    assert field.link.robot("weaver").alive
    assert _texts(field)[-1] == "weaver is connected"


def test_a_restarted_robot_is_not_mistaken_for_its_former_self(field: Field):
    former = field.robot(session="first")
    former.publish_map(1)
    field.forward(former, 0.2)
    assert len(field.link.robot("weaver").ground.tiles) == 4
    field.clock.forward(seconds=3.0)
    field.forward(field.robot(session="second"), 0.2)
    record = field.link.robot("weaver")
    assert record.session == "second"
    assert record.generation == 1
    assert not record.ground.tiles
    assert not record.conflict(field.clock.now_ns())
    assert any("started anew" in text for text in _texts(field))


def test_what_a_restarted_robot_says_before_its_first_heartbeat_is_kept(field: Field):
    former = field.robot(session="first")
    former.publish_map(2)
    field.forward(former, 0.2)
    field.clock.forward(seconds=3.0)
    later = field.robot(session="second")
    later.publish_map(1)
    field.forward(later, 0.1)
    record = field.link.robot("weaver")
    assert len(record.ground.tiles) == 4
    assert sum(key.startswith("tele/map/") for key in record.values) == 4


def test_two_robots_with_one_id_are_reported_until_one_is_gone(field: Field):
    first, second = field.robot(session="first"), field.robot(session="second")
    field.forward(first, 0.2)
    for _ in range(10):
        field.forward(second, 0.02)
        field.forward(first, 0.02)
    record = field.link.robot("weaver")
    assert record.session == "second"
    assert "two robots answer to the id 'weaver'" in describe(record, field.clock.now_ns())["conflict"]
    assert sum("two robots" in text for text in _texts(field)) == 1
    assert record.generation == 1
    field.forward(second, 2.5)
    assert record.conflict(field.clock.now_ns()) == ""


def test_a_robot_of_unknown_make_is_listed_without_a_figure(field: Field):
    presence = Presence(robot_id="alien", session="s", kind="REAL", robot="walker-9", world="", schema=1)
    field.bus.publish("alien", topics.PRESENCE, presence)
    entry = describe(field.link.robot("alien"), field.clock.now_ns())
    assert (entry["robot"], entry["leg_names"], entry["alive"]) == ("walker-9", [], False)


def test_processes_are_told_apart_and_their_end_is_an_event(field: Field):
    field.robot()
    assert field.link.robot("weaver").processes == {"walk"}
    field.bus.announce("weaver", "vision")
    assert field.link.robot("weaver").processes == {"walk", "vision"}
    field.bus.close()
    assert field.link.robot("weaver").processes == set()
    assert "process vision of weaver is gone" in _texts(field)


def test_lost_heartbeats_are_counted_by_the_robots_clock(field: Field):
    def beat(number: int) -> None:
        heartbeat = Heartbeat(stamp_ns=number * 50_000_000, sequence=number, session="first")
        field.bus.publish("weaver", topics.HEARTBEAT, heartbeat)

    def beats(numbers: list[int]) -> None:
        for number in numbers:
            beat(number)
        field.clock.forward(seconds=1.0)
        field.link.check()

    beats(list(range(1, 21)))
    assert field.link.robot("weaver").loss is None  # nobody knows how many there were before
    beats(list(range(21, 41)))
    assert field.link.robot("weaver").loss == 0.0
    beats([number for number in range(41, 61) if number % 4])
    assert field.link.robot("weaver").loss == pytest.approx(1 - 15 / 19)  # the last one heard is the 59th
    beats([])
    assert field.link.robot("weaver").loss is None


def test_rates_are_measured_a_key(field: Field):
    field.forward(field.robot(), 2.1)
    rates = field.link.robot("weaver").rates
    assert abs(rates["tele/state"] - 50.0) < 1.0
    assert abs(rates["state/mode"] - 10.0) < 1.5


def test_the_list_changes_only_with_what_matters(field: Field):
    robot = field.robot()
    field.forward(robot, 0.2)
    roster = Roster(field.link)
    roster.refresh()
    assert roster.version == 1
    field.forward(robot, 0.3)
    roster.refresh()
    assert roster.version == 1
    robot.mode = "STAND"
    field.forward(robot, 0.2)
    roster.refresh()
    assert roster.version == 2


def test_the_end_of_a_replay_is_no_loss(field: Field):
    replay = field.robot("replay-a", kind="REPLAY")
    field.forward(replay, 2.5)
    field.bus.announce("replay-a", "replay")
    assert field.link.robot("replay-a").loss is None  # its clock is wound and paused
    field.clock.forward(seconds=1.5)
    field.link.check()
    assert _texts(field)[-1] == "the replay has ended"
    assert not [text for text in _texts(field) if "is lost" in text or "process replay" in text]
