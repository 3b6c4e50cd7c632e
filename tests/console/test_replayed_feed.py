"""A replay shows, frame by frame, the values that the live robot showed; winding it back voids what came later."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from wire_robot import WireRobot, ground_tile

from robot_agent.recording import Recorder, RecordingWriter
from robot_agent.recording.playback import Playback
from robot_agent.recording.player import Player
from weaver_console.event_log import EventLog
from weaver_console.feed import Feed
from weaver_console.link import Link
from weaver_console.roster import Roster
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, CameraPicture, Command, CommandName, Waypoint
from weaver_shared.robots import load_robot

TICK = 0.02
TICKS = 200
ROBOT_ID, REPLAY_ID = "weaver", "replay-run"
Frame = list[tuple[str, str, int, Any]]


@dataclass
class Watcher:
    """A console with one page on it."""

    robot_id: str
    bus: MemoryBus = field(default_factory=MemoryBus)
    clock: SimulatedClock = field(default_factory=lambda: SimulatedClock(1_000_000_000))
    link: Link = field(init=False)
    feed: Feed = field(init=False)

    def __post_init__(self) -> None:
        self.link = Link(self.bus, clock=self.clock, events=EventLog(lambda: 0.0))
        self.link.open()
        self.feed = Feed(self.link, Roster(self.link))
        self.feed.cameras = True
        self.feed.select(self.robot_id)

    def forward(self, act: Callable[[], None]) -> None:
        self.clock.forward(seconds=TICK)
        act()
        self.link.check()

    def frame(self) -> Frame:
        """The values that the page is sent now, without those that only replays have."""
        told = [json.loads(message) for message in self.feed.collect()]
        values = [m for m in told if m["type"] == "value" and not m["key"].startswith("state/replay")]
        return [(m["key"], m["kind"], m["stamp_ns"], m["value"]) for m in values]


def _live(robot: WireRobot, tick: int) -> None:
    """One tick of a robot that walks, while its map grows and its camera looks."""
    robot.step()
    if tick % 7 == 0:
        i = tick // 7 % 5
        robot.bus.publish(ROBOT_ID, topics.MAP_TILE, ground_tile(i, -1, stamp_ns=robot.tick * 20_000_000), i=i, j=-1)
    if tick % 10 == 0:
        picture = CameraPicture(stamp_ns=robot.tick * 20_000_000, name="left", jpeg=bytes([tick]))
        robot.bus.publish(ROBOT_ID, topics.CAMERA, picture, name="left")


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Frame]]:
    """A recording, and each frame that the page was sent while it was made."""
    path = tmp_path_factory.mktemp("replay") / "run.mcap"
    watcher = Watcher(ROBOT_ID)
    robot = WireRobot(watcher.bus, ROBOT_ID)
    robot.mode, robot.phase = "WALK", "active"
    robot.waypoints = (Waypoint(x=0.5, y=0.0), Waypoint(x=0.5, y=0.4))
    writer = RecordingWriter(path, robot_id=ROBOT_ID, robot=load_robot(), clock=watcher.clock, started="now")
    recorder = Recorder(watcher.bus, ROBOT_ID, writer)
    frames = []
    for tick in range(TICKS):
        watcher.forward(lambda tick=tick: _live(robot, tick))
        recorder.turn()
        frames.append(watcher.frame())
    robot.answer(Command(command=CommandName.STOP, operator="anna", lease_epoch=0, sequence=1))
    recorder.turn()
    writer.close()
    return path, frames


@dataclass
class Replay:
    watcher: Watcher
    player: Player

    def forward(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK)):
            self.watcher.forward(self.player.turn)

    def order(self, name: CommandName, value: float = 0.0) -> Answer:
        command = Command(command=name, operator="ben", lease_epoch=0, sequence=1, value=value)
        return self.watcher.bus.ask(REPLAY_ID, topics.REPLAY_COMMANDS, command)

    @property
    def shown(self) -> dict[str, Any]:
        """Values that the console has, by key."""
        record = self.watcher.link.robot(REPLAY_ID)
        assert record is not None
        return {key: json.loads(value.json) for key, value in record.values.items()}


@pytest.fixture
def replay(lived: tuple[Path, list[Frame]]) -> Iterator[Replay]:
    playback = Playback(lived[0])
    watcher = Watcher(REPLAY_ID)
    yield Replay(watcher, Player(playback, watcher.bus, watcher.clock, replay_id=REPLAY_ID, run="a"))
    playback.close()


def test_a_replay_shows_frame_by_frame_what_was_shown_live(lived: tuple[Path, list[Frame]], replay: Replay) -> None:
    told: set[str] = set()
    for number, frame in enumerate(lived[1]):
        replay.forward(TICK)
        assert replay.watcher.frame() == frame, f"frame {number}"
        told |= {key for key, *_ in frame}
    assert {"tele/state", "tele/gait", "state/mission", "tele/cam/left", "tele/map/tile/4_-1", "truth/state"} <= told


def test_it_is_a_robot_of_its_own_kind_that_obeys_nobody(replay: Replay) -> None:
    replay.forward(0.1)
    record = replay.watcher.link.robot(REPLAY_ID)
    assert record is not None
    assert record.presence is not None
    assert (record.presence.kind, record.presence.robot, record.alive) == ("REPLAY", "weaver", True)
    for name in (CommandName.TAKE_CONTROL, CommandName.STOP):
        answer = replay.watcher.bus.request(REPLAY_ID, Command(command=name, operator="b", lease_epoch=0, sequence=1))
        assert not answer.accepted
        assert "recording" in answer.reason


def test_a_paused_replay_stands_still_and_stays_alive(replay: Replay) -> None:
    replay.forward(1.0)
    assert replay.order(CommandName.PLAY_REPLAY, 0.0).accepted
    replay.forward(0.2)
    before = replay.shown
    replay.forward(3.0)
    assert replay.shown == before
    assert before["state/replay"]["speed"] == 0.0
    assert replay.watcher.link.robot(REPLAY_ID).alive  # type: ignore[union-attr]


def test_twice_the_speed_takes_half_the_time_and_the_end_pauses(replay: Replay) -> None:
    replay.order(CommandName.PLAY_REPLAY, 2.0)
    replay.forward(1.0)
    assert replay.shown["state/replay"]["seconds"] == pytest.approx(2.0, abs=0.25)
    replay.forward(3.0)
    state = replay.shown["state/replay"]
    assert (state["seconds"], state["speed"]) == (state["length"], 0.0)
    replay.order(CommandName.PLAY_REPLAY, 1.0)
    replay.forward(0.5)
    assert 0.1 < replay.shown["state/replay"]["seconds"] < 0.5


@pytest.mark.parametrize("seconds", [0.0, 0.7, 2.5])
def test_a_moment_jumped_to_shows_what_held_then(lived: tuple[Path, list[Frame]], replay: Replay, seconds: float):
    held: dict[str, Any] = {}
    playback = Playback(lived[0])
    for said in playback.between(0, playback.first_ns + round(seconds * 1e9)):
        held[said.topic.at(**said.parts)] = said.message.stamp_ns if hasattr(said.message, "stamp_ns") else None
    playback.close()
    replay.forward(1.5)
    replay.order(CommandName.PLAY_REPLAY, 0.0)
    assert replay.order(CommandName.JUMP_REPLAY, seconds).accepted
    replay.forward(0.3)
    shown = {key: value.get("stamp_ns") for key, value in replay.shown.items() if not key.startswith("state/replay")}
    assert shown == held
    assert replay.shown["state/replay"]["seconds"] == pytest.approx(seconds, abs=1e-4)


def test_events_are_marks_to_jump_to_and_are_not_logged_again(replay: Replay) -> None:
    replay.forward(TICKS * TICK)
    (mark,) = replay.shown["state/replay_marks"]["marks"]
    assert (mark["source"], mark["text"]) == ("anna", "stop: accepted")
    assert mark["seconds"] == pytest.approx((TICKS - 1) * TICK)
    assert [event.text for event in replay.watcher.link.events.latest()] == ["the replay runs"]


@pytest.mark.parametrize(("name", "value"), [("play_replay", -1.0), ("play_replay", 21.0), ("jump_replay", 60.0),
                                             ("jump_replay", float("nan")), ("stand", 0.0)])  # fmt: skip
def test_what_a_replay_can_not_do_is_refused(replay: Replay, name: str, value: float) -> None:
    answer = replay.order(CommandName(name), value)
    assert not answer.accepted
    assert answer.reason


def test_a_replay_that_has_ended_leaves_the_list_of_robots(replay: Replay) -> None:
    replay.forward(0.1)
    assert replay.order(CommandName.END_REPLAY).accepted
    assert replay.player.ended
    replay.watcher.bus.close()
    for _ in range(60):
        replay.watcher.forward(lambda: None)
    assert replay.watcher.link.robot(REPLAY_ID) is None
    assert replay.watcher.frame() == []


def test_a_recording_that_was_cut_off_is_replayed_up_to_there(lived: tuple[Path, list[Frame]], tmp_path: Path) -> None:
    whole = lived[0].read_bytes()
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(whole[: round(0.6 * len(whole))])
    ours, theirs = Playback(cut), Playback(lived[0])
    until = ours.last_ns
    assert theirs.first_ns == ours.first_ns < until < theirs.last_ns
    stamps = [[said.topic.key for said in one.between(0, until - 1)] for one in (ours, theirs)]
    assert stamps[0] == stamps[1]
    ours.close()
    theirs.close()
