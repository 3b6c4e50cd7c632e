"""What was recorded reads back as it was, up to the last second before a crash, and other files are refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from made_up_recordings import ROBOT, ROBOT_ID, begun, felt, heartbeat, lease, pair, write
from mcap.reader import make_reader

from robot_agent.recording import file_format, open_recording, reader
from robot_agent.recording.packed_pictures import PackedStereoFrame, PicturePacker, unpack
from robot_agent.recording.span import recorded_span
from weaver_shared import codec, topics
from weaver_shared.clock import SimulatedClock
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.messages import ModeState, SafetyAction, StereoFrame


def stamps_in(path: Path) -> list[int]:
    return [message.stamp_ns for _, _, message in open_recording(path).messages(topics.PROPRIOCEPTION)]


def test_messages_come_back_bit_for_bit_and_in_order(tmp_path: Path) -> None:
    generator = np.random.default_rng(2)
    said = [
        (topics.HEARTBEAT.key, heartbeat(10)),
        (topics.STEREO.key, pair(30, generator)),
        (topics.PROPRIOCEPTION.key, felt(40, generator)),
        (topics.HEARTBEAT.key, heartbeat(35)),
        (topics.LEASE.key, lease(3)),
    ]
    writer = begun(tmp_path / "a.mcap", SimulatedClock())
    for key, message in said:
        writer.write(key, message)
    writer.close()
    recording = open_recording(tmp_path / "a.mcap")
    wanted = (topics.HEARTBEAT, topics.STEREO, topics.PROPRIOCEPTION, topics.LEASE)
    read = list(recording.messages(*wanted))
    assert [(key, codec.encode(message)) for _, key, message in read] == [(k, codec.encode(m)) for k, m in said]
    assert [came for came, _, _ in read] == [10, 30, 40, 40, 40]
    assert [key for _, key, _ in recording.messages(topics.LEASE)] == ["state/lease"]


def test_what_was_said_long_ago_does_not_lengthen_a_recording(tmp_path: Path) -> None:
    writer = begun(tmp_path / "a.mcap", SimulatedClock())
    old = ModeState(
        stamp_ns=5, mode="STAND", action=SafetyAction.ALLOW, reasons=(), stopped=False, stop_level="", allowed=()
    )
    for key, message in (
        (topics.LEASE.key, lease(1)),
        (topics.MODE.key, old),
        (topics.HEARTBEAT.key, heartbeat(7_000_000_000)),
        (topics.HEARTBEAT.key, heartbeat(8_000_000_000)),
    ):
        writer.write(key, message)
    assert writer.seconds == 1.0
    writer.close()
    assert recorded_span(tmp_path / "a.mcap") == (1.0, True)
    read = list(open_recording(tmp_path / "a.mcap").messages(topics.LEASE, topics.MODE))
    assert [(came, key) for came, key, _ in read] == [(7_000_000_000, "state/lease"), (7_000_000_000, "state/mode")]


def test_a_recording_knows_the_robot_as_it_was_configured(tmp_path: Path) -> None:
    write(tmp_path / "a.mcap", seconds=0.1, pictures=False)
    recording = open_recording(tmp_path / "a.mcap")
    assert recording.robot == ROBOT
    assert recording.about.robot_id == ROBOT_ID
    assert recording.about.started == "2026-01-02T03:04:05+00:00"
    assert not recording.about.pictures


def test_other_tools_find_the_channels_and_their_fields(tmp_path: Path) -> None:
    write(tmp_path / "a.mcap", seconds=0.2)
    with (tmp_path / "a.mcap").open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    assert {channel.topic for channel in summary.channels.values()} == {
        "weaver/sim-1/sensor/body",
        "weaver/sim-1/sensor/stereo",
        "weaver/sim-1/state/lease",
    }
    texts = {schema.name: schema.data.decode() for schema in summary.schemas.values()}
    assert '"left_shape":' in texts["PackedStereoFrame"]
    assert summary.statistics is not None
    assert summary.statistics.message_end_time == 200_000_000


def test_a_file_cut_anywhere_reads_up_to_the_second_before(tmp_path: Path) -> None:
    on_disk, stamps = write(tmp_path / "whole.mcap", seconds=4.0)
    data = (tmp_path / "whole.mcap").read_bytes()
    times, sizes = np.array(on_disk).T
    cut = tmp_path / "cut.mcap"
    for end in np.linspace(sizes[0], len(data), 30).astype(int):
        cut.write_bytes(data[:end])
        kept = stamps_in(cut)
        written_ns = times[np.searchsorted(sizes, end).clip(max=len(times) - 1)]
        assert kept == stamps[: len(kept)]
        assert len(kept) >= sum(stamp <= written_ns - 1_000_000_000 for stamp in stamps)


def test_a_damaged_middle_ends_the_reading_there(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    _, stamps = write(tmp_path / "a.mcap")
    data = bytearray((tmp_path / "a.mcap").read_bytes())
    data[len(data) // 2 : len(data) // 2 + 64] = bytes(64)
    (tmp_path / "a.mcap").write_bytes(data)
    kept = stamps_in(tmp_path / "a.mcap")
    assert kept == stamps[: len(kept)]
    assert len(stamps) // 4 < len(kept) < len(stamps)
    assert "cut off" in caplog.text


@given(
    left=arrays(np.uint8, st.tuples(st.integers(0, 9), st.integers(0, 9))),
    right=arrays(np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9))),
)
def test_pictures_are_packed_without_loss(left: np.ndarray, right: np.ndarray) -> None:
    frame = StereoFrame(stamp_ns=1, sequence=2, left=left, right=right)
    packed = codec.decode(codec.encode(PicturePacker().pack(frame)), PackedStereoFrame)
    assert codec.encode(unpack(packed)) == codec.encode(frame)


def test_a_picture_that_lies_about_its_size_is_refused() -> None:
    packed = PicturePacker().pack(pair(1, np.random.default_rng(1)))
    bytes_of_less = PackedStereoFrame(
        stamp_ns=1, sequence=1, left_shape=(24, 16), right_shape=(24, 32), left=packed.left, right=packed.right
    )
    with pytest.raises(InputError, match="recorded picture"):
        unpack(bytes_of_less)


def test_a_recording_is_never_written_over(tmp_path: Path) -> None:
    write(tmp_path / "a.mcap", seconds=0.1)
    with pytest.raises(ResourceError, match="exists already"):
        begun(tmp_path / "a.mcap", SimulatedClock())


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 something else", b"\x89MCAP0\r\n"])
def test_what_is_no_recording_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.mcap").write_bytes(content)
    with pytest.raises(InputError, match="is not an MCAP recording"):
        open_recording(tmp_path / "a.mcap")


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="can not be read: No such file"):
        open_recording(tmp_path / "a.mcap")


def test_a_recording_of_another_schema_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(codec, "SCHEMA_VERSION", 2)
    write(tmp_path / "a.mcap", seconds=0.1)
    monkeypatch.undo()
    with pytest.raises(InputError, match="recorded with message schema 2, this version reads 1"):
        open_recording(tmp_path / "a.mcap")


def test_a_message_with_other_fields_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "a.mcap", seconds=0.1)
    known = file_format.schema_of(LeaseWas := type(lease(1)))
    monkeypatch.setattr(file_format, "schema_of", lambda kind: known.replace(b"epoch", b"number"))
    with pytest.raises(InputError, match="another version: its LeaseState has the fields holder, epoch"):
        list(reader.open_recording(tmp_path / "a.mcap").messages(topics.LEASE))
    assert LeaseWas is topics.LEASE.message
