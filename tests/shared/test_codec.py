"""Messages survive the wire exactly, and nothing that is not a message passes for one."""

import dataclasses
import enum
import math
import typing
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from weaver_shared import codec
from weaver_shared.errors import MessageError
from weaver_shared.messages import Answer, Event, Heartbeat, ImuBatch, MapTile, MissionState, Severity, Waypoint

KINDS = sorted(codec.MESSAGES.values(), key=lambda kind: kind.__name__)
SCALARS: dict[Any, st.SearchStrategy[Any]] = {
    int: st.integers(-(2**63), 2**63 - 1),
    float: st.floats(),
    bool: st.booleans(),
    str: st.text(max_size=20),
    bytes: st.binary(max_size=40),
}


def values_of(hint: Any) -> st.SearchStrategy[Any]:
    """Any value that a field of this type may hold."""
    if hint in SCALARS:
        return SCALARS[hint]
    if typing.get_origin(hint) is np.ndarray:
        dtype = np.dtype(typing.get_args(typing.get_args(hint)[1])[0])
        return arrays(dtype, array_shapes(min_dims=1, max_dims=3, min_side=0, max_side=4))
    if typing.get_origin(hint) is tuple:
        return st.lists(values_of(typing.get_args(hint)[0]), max_size=3).map(tuple)
    if issubclass(hint, enum.Enum):
        return st.sampled_from(hint)
    return messages_of(hint)


def messages_of(kind: type[Any]) -> st.SearchStrategy[Any]:
    hints = typing.get_type_hints(kind)
    return st.builds(kind, **{field.name: values_of(hints[field.name]) for field in dataclasses.fields(kind)})


def assert_same(one: Any, other: Any) -> None:
    assert type(one) is type(other)
    if dataclasses.is_dataclass(one):
        for field in dataclasses.fields(one):
            assert_same(getattr(one, field.name), getattr(other, field.name))
    elif isinstance(one, tuple):
        assert len(one) == len(other)
        for mine, theirs in zip(one, other, strict=True):
            assert_same(mine, theirs)
    elif isinstance(one, np.ndarray):
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other)
    else:
        assert one == other or (isinstance(one, float) and math.isnan(one) and math.isnan(other))


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
@settings(max_examples=20, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_decoding_undoes_encoding(kind: type[Any], data: st.DataObject) -> None:
    message = data.draw(messages_of(kind))
    assert_same(codec.decode(codec.encode(message), kind), message)


@pytest.mark.parametrize("kind", [ImuBatch, MapTile, MissionState, Answer], ids=lambda kind: kind.__name__)
@settings(max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_damaged_bytes_are_refused_or_still_a_whole_message(kind: type[Any], data: st.DataObject) -> None:
    whole = bytearray(codec.encode(data.draw(messages_of(kind))))
    for _ in range(data.draw(st.integers(1, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    cut = whole[: data.draw(st.integers(0, len(whole)))] if data.draw(st.booleans()) else whole
    try:
        message = codec.decode(cut, kind)
    except MessageError:
        return
    codec.decode(codec.encode(message), kind)


@given(rubbish=st.binary(max_size=60))
def test_rubbish_is_refused(rubbish: bytes) -> None:
    with pytest.raises(MessageError):
        codec.decode(rubbish, Heartbeat)


def test_the_wire_format_has_not_moved() -> None:
    # Old recordings hold these bytes: a change needs a new SCHEMA_VERSION.
    assert codec.SCHEMA_VERSION == 1
    answer = Answer(accepted=True, reason="ok", lease_epoch=3, applied_value=0.5)
    assert codec.encode(answer).hex() == "9601a6416e73776572c3a26f6b03cb3fe0000000000000"
    event = Event(stamp_ns=7, severity=Severity.WARNING, source="walk", text="")
    assert codec.encode(event).hex() == "9601a54576656e7407a77761726e696e67a477616c6ba0"
    mission = MissionState(
        stamp_ns=1,
        phase="ready",
        waypoints=(Waypoint(x=1.0, y=-2.0),),
        next_waypoint=0,
        cross_track_error=0.0,
        distance_left=2.0,
        lookahead_in_world=np.array([1.0, 0.5]),
    )
    assert codec.encode(mission).hex() == (
        "9901ac4d697373696f6e537461746501a57265616479"
        "9192cb3ff0000000000000cbc000000000000000"
        "00cb0000000000000000cb4000000000000000"
        "93a33c66389102c410000000000000f03f000000000000e03f"
    )


def test_arrays_are_sent_in_row_order_whatever_their_memory_is() -> None:
    tile = np.arange(6, dtype=np.int16).reshape(2, 3)
    spread = np.zeros((4, 6), dtype=np.int16)
    spread[::2, ::2] = tile
    assert sent(elevation(spread[::2, ::2])) == sent(elevation(tile)) == sent(elevation(np.asfortranarray(tile)))
    assert sent(elevation(tile.astype(">i2"))) == sent(elevation(tile))


def elevation(values: np.ndarray) -> MapTile:
    indices = np.zeros((2, 3), dtype=np.uint8)
    return MapTile(
        stamp_ns=0,
        i=0,
        j=0,
        size=2,
        cell=0.02,
        elevation_mm=values,
        sigma_mm=indices,
        roughness=indices,
        step_height=indices,
        age_s=indices,
    )


def sent(message: Any) -> bytes:
    return codec.encode(message)


def test_decoded_arrays_can_not_be_written_to() -> None:
    batch = codec.decode(codec.encode(ImuBatch.empty()), ImuBatch)
    assert not batch.angular_velocity_in_imu.flags.writeable


def tampered(**changes: Any) -> bytes:
    parts = {"version": 1, "tag": "Heartbeat", "fields": [5, 6, "abc"]} | changes
    return msgspec.msgpack.encode([parts["version"], parts["tag"], *parts["fields"]])


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (tampered(version=2), "schema 2 is not ours, which is 1; update both ends"),
        (tampered(tag="Event"), "expected Heartbeat, got 'Event'"),
        (tampered(fields=[5, 6]), "2 fields, expected 3"),
        (tampered(fields=["five", 6, "abc"]), "Expected `int`, got `str`"),
        (msgspec.msgpack.encode({"a": 1}), "expected a list"),
        (b"", "not a MessagePack message"),
        (b"\x91" * 4000, "not a MessagePack message"),
    ],
)
def test_a_refusal_says_what_is_wrong(data: bytes, sentence: str) -> None:
    with pytest.raises(MessageError, match=sentence):
        codec.decode(data, Heartbeat)


def test_a_field_added_since_a_message_was_recorded_has_its_default() -> None:
    whole = msgspec.msgpack.decode(codec.encode(Answer(accepted=True, reason="ok", lease_epoch=3, applied_value=0.5)))
    assert codec.decode(msgspec.msgpack.encode(whole[:-1]), Answer) == Answer(
        accepted=True, reason="ok", lease_epoch=3, applied_value=0.0
    )
    with pytest.raises(MessageError, match="5 fields, expected 4"):
        codec.decode(msgspec.msgpack.encode([*whole, 0.0]), Answer)


@pytest.mark.parametrize(
    ("array", "sentence"),
    [
        (["<f4", [1, 3], b"\0" * 12], "array of '<f4' where float64 belongs"),
        (["<f8", [1, 3], b"\0" * 23], "does not hold 23 bytes"),
        (["<f8", [-1, 3], b"\0" * 24], "damaged shape"),
        (["<f8", [0, 2**63], b""], "ImuBatch"),
        (["|O", [1], b"\0" * 8], "array of '|O'"),
        ([["<f8"], [1], b"\0" * 8], "ImuBatch"),
        ("no array", "dtype, shape and bytes"),
    ],
)
def test_a_damaged_array_is_refused(array: Any, sentence: str) -> None:
    empty = ["<i8", [0], b""]
    with pytest.raises(MessageError, match=sentence.replace("|", r"\|")):
        codec.decode(
            msgspec.msgpack.encode([1, "ImuBatch", empty, ["<f8", [0, 3], b""], array]),
            ImuBatch,
        )


def test_what_is_not_a_message_is_not_sent() -> None:
    with pytest.raises(TypeError):
        codec.encode(object())
