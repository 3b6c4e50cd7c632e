"""The table of topics is unambiguous and complete."""

import itertools

import pytest

from weaver_shared import codec, topics
from weaver_shared.errors import ConfigurationError
from weaver_shared.messages import Answer, Command, Waypoint
from weaver_shared.topics import MAP_TILE, MODE, QUERIES, TOPICS, Policy, Priority, robot_key, topic_of

FILLED = {"process": "walk", "i": -3, "j": 12, "name": "left"}
ASKED = {kind.__name__ for query in QUERIES for kind in (query.question, query.answer)}
PARTS = {
    "AdaptationReport",
    "CalibrationMotion",
    "CalibrationWish",
    "GaitParameters",
    "ImuBatch",
    "LoopTiming",
    "RecordingEntry",
    "ReplayMark",
    "Waypoint",
}  # travel within others


def test_a_filled_key_leads_back_to_its_topic() -> None:
    for topic in TOPICS:
        assert topic_of(topic.at(**FILLED)) is topic


def test_no_topic_hides_another() -> None:
    for one, other in itertools.permutations(TOPICS, 2):
        assert one.at(**FILLED) != other.at(**FILLED)
        assert "{" not in other.key or not one.at(**FILLED).startswith(other.key.partition("{")[0])


def test_every_message_travels_somewhere() -> None:
    assert {topic.message.__name__ for topic in TOPICS} | ASKED | PARTS == set(codec.MESSAGES)
    assert {Command, Answer, Waypoint} <= set(codec.MESSAGES.values())


def test_only_what_must_be_on_time_is_real_time() -> None:
    urgent = {topic.key for topic in TOPICS if topic.priority is Priority.REAL_TIME}
    assert urgent == {"hb", "teleop", "tele/odometry"}


def test_a_refusal_of_any_question_keeps_its_reason() -> None:
    assert [query.refuse("too late").reason for query in QUERIES] == ["too late"] * len(QUERIES)
    assert len({query.key for query in QUERIES}) == len(QUERIES)


def test_state_reaches_late_joiners() -> None:
    for topic in TOPICS:
        assert topic.key.startswith("state/") <= (topic.policy is Policy.RELIABLE)


def test_patterns_cover_every_filling() -> None:
    assert MAP_TILE.at(i=-3, j=12) == "tele/map/tile/-3_12"
    assert MAP_TILE.pattern == "tele/map/tile/**"
    assert MODE.pattern == MODE.at() == "state/mode"


def test_an_unknown_key_is_refused_by_name() -> None:
    with pytest.raises(ConfigurationError, match="'tele/mood' is not in the table"):
        topic_of("tele/mood")


@pytest.mark.parametrize("robot_id", ["", "a/b", "weaver *", "**", "weaver.1"])
def test_a_robot_id_is_one_segment_of_a_key(robot_id: str) -> None:
    with pytest.raises(ConfigurationError, match="use letters, digits, - and _"):
        robot_key(robot_id, "hb")


def test_keys_lie_under_their_robot() -> None:
    assert robot_key("weaver-1", MODE.at()) == f"{topics.ROOT}/weaver-1/state/mode"
