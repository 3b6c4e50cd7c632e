"""What a page may say is checked at the door."""

import contextlib
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from weaver_console.page_messages import LARGEST_FRAME, CommandRequest, Place, Select, read_page_message
from weaver_shared.errors import MessageError
from weaver_shared.messages import CommandName


def test_a_command_is_read_with_its_fields():
    text = '{"type":"command","id":"7","command":"set_mission","waypoints":[{"x":1,"y":-2.5}],"new":1}'
    request = read_page_message(text)
    assert request == CommandRequest(id="7", command=CommandName.SET_MISSION, waypoints=[Place(x=1.0, y=-2.5)])
    assert read_page_message('{"type":"select","robot":null}') == Select(robot=None)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{",
        '{"type":"fly"}',
        '{"type":"command","id":"1","command":"explode"}',
        '{"type":"command","id":1,"command":"stand"}',
        '{"type":"command","command":"stand"}',
        '{"type":"draft","waypoints":[{"x":null,"y":0}]}',
        '{"type":"draft","waypoints":[{"x":NaN,"y":0}]}',
        '{"type":"teleop","forward":"fast","left":0,"turn":0,"dead_man":true}',
        b"\xff\xfe",
        "[" * 100_000,
    ],
)
def test_what_is_no_message_is_refused_with_a_sentence(text):
    with pytest.raises(MessageError, match="understood"):
        read_page_message(text)


def test_oversized_frames_and_missions_are_refused():
    with pytest.raises(MessageError, match="256 kB"):
        read_page_message('{"type":"ping","t":' + "1" * LARGEST_FRAME + "}")
    many = {"type": "draft", "waypoints": [{"x": 0, "y": 0}] * 1001}
    with pytest.raises(MessageError, match="1000 waypoints"):
        read_page_message(json.dumps(many))


json_values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=12,
)
kinds = st.sampled_from(["select", "command", "retain", "teleop", "draft", "layer", "view", "watch", "ping", "other"])
fields = st.sampled_from(["robot", "id", "command", "waypoints", "name", "value", "forward", "t", "cameras", "follow"])


@given(kind=kinds, rest=st.dictionaries(fields, json_values, max_size=5))
def test_no_json_object_does_more_than_be_refused(kind, rest):
    with contextlib.suppress(MessageError):
        read_page_message(json.dumps({**rest, "type": kind}))


@given(st.binary(max_size=300))
def test_no_bytes_do_more_than_be_refused(data):
    with contextlib.suppress(MessageError):
        read_page_message(data)
