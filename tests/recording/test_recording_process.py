"""An operator's orders begin and end recordings; what is in the way is said in a sentence."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_up_recordings import ROBOT, ROBOT_ID, felt, heartbeat, pair, write

from robot_agent import recording_process
from robot_agent.recording import open_recording
from robot_agent.recording.store import RecordingStore
from robot_agent.recording_process import RecordingProcess
from robot_agent.replays import Replays
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import (
    Answer,
    Command,
    CommandName,
    Event,
    Heartbeat,
    PartRequest,
    RecordingState,
    StereoFrame,
)

START, STOP, REPLAY = CommandName.START_RECORDING, CommandName.STOP_RECORDING, CommandName.START_REPLAY


@dataclass(kw_only=True)
class Desk:
    """A recorder on a bus of its own, with somebody who gives it orders."""

    bus: MemoryBus
    clock: SimulatedClock
    process: RecordingProcess
    workers: ThreadPoolExecutor
    played: list[tuple[Path, str]]
    told: list[RecordingState] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)

    def order(self, name: CommandName, value: float = 0.0, text: str = "") -> Answer:
        command = Command(command=name, operator="anna", lease_epoch=0, sequence=1, value=value, name=text)
        asked = self.workers.submit(self.bus.ask, ROBOT_ID, topics.RECORDER_COMMANDS, command)
        while not asked.done():
            self.process.turn()
        return asked.result()

    def forward(self, seconds: float) -> None:
        self.clock.forward(seconds=seconds)
        self.process.turn()


@pytest.fixture
def desk(tmp_path: Path) -> Iterator[Desk]:
    bus, clock = MemoryBus(), SimulatedClock()
    heard = MemoryBusEar(bus)
    played: list[tuple[Path, str]] = []
    process = RecordingProcess(
        robot_id=ROBOT_ID,
        robot=ROBOT,
        bus=bus,
        open_bus=heard.open,
        store=RecordingStore(tmp_path / "recordings"),
        replays=Replays(lambda path, name: _playing(played, path, name)),
        clock=clock,
        wall_time=lambda: datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC),
    )
    with ThreadPoolExecutor(1) as workers:
        made = Desk(bus=bus, clock=clock, process=process, workers=workers, played=played)
        bus.subscribe(ROBOT_ID, topics.RECORDING, lambda _id, _key, state: made.told.append(state))
        bus.subscribe(ROBOT_ID, topics.EVENT, lambda _id, _key, event: made.events.append(event))
        yield made
        process.close()


class Playing:
    """A process that plays until it is told to end."""

    ended = False

    def poll(self) -> int | None:
        return 0 if self.ended else None

    def terminate(self) -> None:
        self.ended = True

    def wait(self, timeout: float) -> int:
        return 0


def _playing(played: list[tuple[Path, str]], path: Path, name: str) -> Playing:
    played.append((path, name))
    return Playing()


class MemoryBusEar:
    """Opens further ends of a bus that can be closed one by one."""

    def __init__(self, bus: MemoryBus) -> None:
        self._bus = bus

    def open(self) -> MemoryBus:
        ear = MemoryBus()
        for topic in topics.TOPICS:
            self._bus.subscribe("*", topic, self._to(ear, topic))
        return ear

    def _to(self, ear: MemoryBus, topic: topics.Topic) -> Callable[[str, str, Any], None]:
        filled = {"process": "walk", "i": 0, "j": 0, "name": "left"}
        return lambda robot_id, _key, message: ear.publish(robot_id, topic, message, **filled)


def test_a_recording_begins_and_ends_as_it_is_told(desk: Desk) -> None:
    generator = np.random.default_rng(1)
    assert desk.order(START, 1.0).accepted
    assert desk.told[-1].active == "sim-1_2026-01-02_03-04-05.mcap"
    for stamp_ns in range(0, 2_000_000_001, 500_000_000):
        desk.bus.publish(ROBOT_ID, topics.STEREO, pair(stamp_ns, generator))
        desk.bus.publish(ROBOT_ID, topics.PROPRIOCEPTION, felt(stamp_ns, generator))
        desk.forward(0.5)
    assert desk.told[-1].seconds == pytest.approx(2.0, abs=0.6)
    assert desk.told[-1].size > 1000
    assert desk.told[-1].pictures
    assert desk.order(STOP).accepted
    state = desk.told[-1]
    assert state.active == ""
    (entry,) = state.entries
    assert (entry.seconds, entry.whole, entry.pictures) == (2.0, True, True)
    kinds = [type(message) for _, _, message in open_recording(Path(state.folder) / entry.name).messages(topics.STEREO)]
    assert kinds == [StereoFrame] * 5
    assert [(event.source, event.text) for event in desk.events] == [
        ("anna", "start recording"),
        ("anna", f"stop recording {entry.name}"),
    ]


def test_a_recording_is_replayed_once_under_a_name_of_its_own(desk: Desk) -> None:
    desk.order(START, 0.0)
    active = desk.told[-1].active
    refused = desk.order(REPLAY, text=active)
    assert not refused.accepted
    assert "still being recorded" in refused.reason
    desk.order(STOP)
    assert desk.order(REPLAY, text=active).accepted
    assert desk.order(REPLAY, text=active).accepted
    ((path, name),) = desk.played
    assert (path.name, name) == (active, "replay-sim-1_2026-01-02_03-04-05")


@pytest.mark.parametrize("name", ["", "../secret.mcap", "never.mcap", "sim-1.txt"])
def test_only_recordings_that_are_there_are_replayed(desk: Desk, name: str) -> None:
    answer = desk.order(REPLAY, text=name)
    assert not answer.accepted
    assert "recording" in answer.reason
    assert not desk.played


def test_pictures_are_left_out_when_nobody_wants_them(desk: Desk) -> None:
    desk.order(START, 0.0)
    desk.bus.publish(ROBOT_ID, topics.STEREO, pair(5, np.random.default_rng(1)))
    desk.bus.publish(ROBOT_ID, topics.HEARTBEAT, heartbeat(7))
    desk.order(STOP)
    path = Path(desk.told[-1].folder) / desk.told[-1].entries[0].name
    assert [key for _, key, _ in open_recording(path).messages(*topics.TOPICS)] == ["event", "hb"]


def test_what_can_not_be_done_is_refused_with_the_reason(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    assert desk.order(STOP).reason == "nothing is being recorded"
    desk.order(START)
    assert "is being recorded already" in desk.order(START).reason
    assert desk.order(CommandName.STAND).reason == "the recorder does not know stand"
    desk.order(STOP)
    monkeypatch.setattr(RecordingStore, "free", lambda _: 1_000_000)
    assert "disk has 1 MB left" in desk.order(START).reason
    assert desk.told[-1].active == ""


def test_a_recording_ends_by_itself_before_the_disk_is_full(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    desk.order(START)
    monkeypatch.setattr(RecordingStore, "free", lambda _: recording_process.LEAST_FREE - 1)
    desk.forward(1.0)
    assert desk.told[-1].active == ""
    assert "left" in desk.told[-1].reason
    assert desk.told[-1].entries[0].whole
    assert "has ended: the robot's disk" in desk.events[-1].text


def test_a_robot_that_was_started_anew_gets_a_new_file(desk: Desk) -> None:
    desk.order(START)
    desk.bus.publish(ROBOT_ID, topics.HEARTBEAT, Heartbeat(stamp_ns=90, sequence=9, session="a"))
    desk.forward(0.1)
    desk.bus.publish(ROBOT_ID, topics.HEARTBEAT, Heartbeat(stamp_ns=1, sequence=1, session="b"))
    desk.forward(0.1)
    assert desk.told[-1].active == "sim-1_2026-01-02_03-04-05_2.mcap"
    assert [entry.name for entry in desk.told[-1].entries] == ["sim-1_2026-01-02_03-04-05.mcap"]


def test_a_file_is_handed_out_in_parts_and_nothing_else_is(desk: Desk, tmp_path: Path) -> None:
    write(tmp_path / "recordings" / "old.mcap", seconds=0.3)
    (tmp_path / "secret.mcap").write_text("secret")
    data = (tmp_path / "recordings" / "old.mcap").read_bytes()

    def part(name: str, offset: int = 0, length: int = 1000) -> tuple[bytes, int, str]:
        got = desk.bus.ask(ROBOT_ID, topics.RECORDING_PART, PartRequest(name=name, offset=offset, length=length))
        return got.data, got.size, got.reason

    assert part("old.mcap", 100) == (data[100:1100], len(data), "")
    assert part("old.mcap", len(data)) == (b"", len(data), "")
    for name in ("../secret.mcap", "/etc/passwd", "", ".mcap", "old.mcap/../../secret.mcap"):
        assert "is not the name of a file here" in part(name)[2]
    assert "can not be read" in part("none.mcap")[2]
    assert "a part begins at 0" in part("old.mcap", -1)[2]
    assert "a part begins at 0" in part("old.mcap", 0, 1 << 40)[2]


def test_files_that_are_cut_are_listed_as_such_and_others_not_at_all(tmp_path: Path) -> None:
    write(tmp_path / "whole.mcap", seconds=3.0)
    (tmp_path / "cut.mcap").write_bytes((tmp_path / "whole.mcap").read_bytes()[:-60_000])
    (tmp_path / "other.mcap").write_text("not ours")
    entries = {entry.name: entry for entry in RecordingStore(tmp_path).entries()}
    assert set(entries) == {"whole.mcap", "cut.mcap"}
    assert entries["whole.mcap"].whole
    assert not entries["cut.mcap"].whole
    assert entries["whole.mcap"].seconds == pytest.approx(2.99)
    assert 0.0 < entries["cut.mcap"].seconds < entries["whole.mcap"].seconds
