"""What a page is told: the newest of each key, no more often than it can use, whatever the page's own pace."""

import json

import numpy as np
import pytest
from running_console import Field

from weaver_console.feed import Feed
from weaver_console.roster import Roster
from weaver_shared.messages import Severity


@pytest.fixture
def feed(field: Field) -> Feed:
    return Feed(field.link, Roster(field.link))


def _read(messages: list[bytes]) -> list[dict]:
    return [json.loads(message) for message in messages]


def _values(messages: list[bytes], key: str) -> list[dict]:
    return [m for m in _read(messages) if m["type"] == "value" and m["key"] == key]


def test_a_page_that_was_away_gets_only_the_newest(field: Field, feed: Feed):
    robot = field.robot()
    field.forward(robot, 0.1)
    feed.select("weaver")
    feed.collect()
    field.forward(robot, 5.0)
    (state,) = _values(feed.collect(), "tele/state")
    assert state["stamp_ns"] == state["value"]["stamp_ns"] == robot.tick * 20_000_000
    assert state["kind"] == "RobotState"
    assert state["age_s"] == 0.0


def test_nothing_is_told_twice(field: Field, feed: Feed):
    field.forward(field.robot(), 0.2)
    feed.select("weaver")
    assert _values(feed.collect(), "tele/state")
    field.clock.forward(seconds=1.0)
    assert not [m for m in _read(feed.collect()) if m["type"] == "value"]


def test_a_fast_page_gets_the_state_up_to_thirty_times_a_second(field: Field, feed: Feed):
    robot = field.robot()
    field.forward(robot, 0.1)
    feed.select("weaver")
    told = 0
    for _ in range(100):
        field.forward(robot, 0.02)
        told += len(_values(feed.collect(), "tele/state"))
    assert 48 <= told <= 60


def test_only_the_selected_robot_is_told_of(field: Field, feed: Feed):
    field.forward(field.robot("one"), 0.2)
    field.forward(field.robot("two"), 0.2)
    assert not [m for m in _read(feed.collect()) if m["type"] == "value"]
    feed.select("two")
    assert {m["robot"] for m in _read(feed.collect()) if m["type"] == "value"} == {"two"}


def test_selecting_again_tells_everything_again(field: Field, feed: Feed):
    field.forward(field.robot(), 0.2)
    feed.select("weaver")
    first = len(feed.collect())
    feed.select("weaver")
    assert len([m for m in _read(feed.collect()) if m["type"] == "value"]) > 5
    assert first > 5


def test_a_large_map_does_not_delay_the_state(field: Field, feed: Feed):
    robot = field.robot()
    robot.publish_map(5)
    field.forward(robot, 0.1)
    feed.select("weaver")
    first = feed.collect()
    assert sum(map(len, first)) < 400_000
    tiles = 0
    for _ in range(20):
        field.forward(robot, 0.06)
        batch = _read(feed.collect())
        assert any(m.get("key") == "tele/state" for m in batch)
        tiles += sum(m.get("key", "").startswith("tele/map/") for m in batch)
    assert tiles + sum(b"tele/map/" in m for m in first) == 100


def test_pictures_are_only_sent_to_those_who_watch(field: Field, feed: Feed):
    from weaver_shared import topics
    from weaver_shared.messages import CameraPicture

    picture = CameraPicture(stamp_ns=1, name="left", jpeg=b"\xff\xd8")
    field.robot()
    field.bus.publish("weaver", topics.CAMERA, picture, name="left")
    feed.select("weaver")
    assert not _values(feed.collect(), "tele/cam/left")
    feed.cameras = True
    (sent,) = _values(feed.collect(), "tele/cam/left")
    assert sent["value"]["jpeg"] == "/9g="


def test_features_are_only_sent_to_those_who_want_them_drawn(field: Field, feed: Feed):
    from weaver_shared import topics
    from weaver_shared.messages import TrackedFeatures

    places = np.array([[3, 4]], dtype=np.int16)
    features = TrackedFeatures(
        stamp_ns=1, width=640, height=480, both_eyes=places, one_eye=places[:0], rejected=places[:0]
    )
    field.robot()
    field.bus.publish("weaver", topics.FEATURES, features, name="left")
    feed.select("weaver")
    feed.cameras = True
    assert not _values(feed.collect(), "tele/features/left")
    feed.features = True
    (sent,) = _values(feed.collect(), "tele/features/left")
    assert sent["value"]["both_eyes"] == [[3, 4]]


def test_a_restart_voids_what_was_told(field: Field, feed: Feed):
    former = field.robot(session="first")
    former.publish_map(1)
    field.forward(former, 0.2)
    feed.select("weaver")
    feed.collect()
    field.forward(field.robot(session="second"), 0.2)
    messages = _read(feed.collect())
    forget = next(index for index, m in enumerate(messages) if m["type"] == "forget")
    values = [index for index, m in enumerate(messages) if m["type"] == "value"]
    assert values
    assert forget < min(values)


def test_events_come_once_and_in_order(field: Field, feed: Feed):
    field.link.events.add("", Severity.INFO, "console", "before")
    past = json.loads(feed.past_events())
    assert [event["text"] for event in past["events"]] == ["before"]
    for text in ("first", "second"):
        field.link.events.add("weaver", Severity.WARNING, "walk", text, stamp_ns=7)
    told = [m for m in _read(feed.collect()) if m["type"] == "event"]
    assert [(m["text"], m["severity"], m["stamp_ns"]) for m in told] == [
        ("first", "warning", 7),
        ("second", "warning", 7),
    ]
    assert not [m for m in _read(feed.collect()) if m["type"] == "event"]


def test_the_state_of_the_link_is_told_twice_a_second(field: Field, feed: Feed):
    robot = field.robot()
    field.forward(robot, 1.2)
    feed.select("weaver")
    told = []
    for _ in range(50):
        field.forward(robot, 0.04)
        told += [m for m in _read(feed.collect()) if m["type"] == "link"]
    assert 4 <= len(told) <= 5
    assert told[-1]["alive"] is True
    assert told[-1]["rates"]["hb"] == pytest.approx(50.0, abs=1.0)
