"""Plays a recording on the bus as a robot of its own: one that can be watched, paused and wound, and obeys nobody."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from dataclasses import replace

from robot_agent.recording.file_format import SUFFIX
from robot_agent.recording.playback import Playback, Said
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.clock import Clock
from weaver_shared.messages import Answer, Command, CommandName, Heartbeat, Presence, ReplayMarks, ReplayState

KIND = "REPLAY"
FASTEST = 20.0
"""Recorded s a second; faster than this nobody sees anything."""

TELL_NS, BEAT_NS, PRESENCE_NS = 100_000_000, 50_000_000, 1_000_000_000

HUSH_NS = 120_000_000
"""Silence after winding back, so that no late word of before is taken for one of the new session."""


def replay_id_of(file_name: str) -> str:
    """The id on the bus of a recording's replay."""
    stem = file_name.removesuffix(SUFFIX)
    return "replay-" + "".join(c if c.isalnum() or c in "-_" else "_" for c in stem)


class Player:
    """`turn` does all the work, some fifty times a second; commands come in on the bus's threads and wait for it."""

    def __init__(
        self, playback: Playback, bus: Bus, clock: Clock, *, replay_id: str, run: str, speed: float = 1.0
    ) -> None:
        """`run` tells this start of the player from others of the same recording."""
        self._playback = playback
        self._bus = bus
        self._clock = clock
        self._replay_id = replay_id
        self._lock = threading.Lock()
        self._jump_to: float | None = None
        self._speed = speed
        self._position = playback.first_ns - 1  # nothing of the first moment has been said yet
        self._turned_ns = clock.now_ns()
        self._hushed_until = 0
        self._winding = False
        self._told_ns = self._beat_ns = self._presented_ns = self._turned_ns - PRESENCE_NS
        self._run = run
        self._session = 0
        self._marks = playback.marks()
        self._beats = 0
        self.ended = False
        recorded = playback.presence()
        self._presence = Presence(
            robot_id=replay_id,
            session="",
            kind=KIND,
            robot=playback.recording.robot.name if recorded is None else recorded.robot,
            world="" if recorded is None else recorded.world,
            schema=1,
        )
        bus.serve(replay_id, lambda _: Answer(accepted=False, reason="this is a recording; it takes no commands"))
        bus.answer_queries(replay_id, topics.REPLAY_COMMANDS, self.answer)
        self._begin_session()
        bus.announce(replay_id, "replay")

    def turn(self) -> None:
        """Say what is due by now. Raises InputError where the file is damaged."""
        now_ns = self._clock.now_ns()
        elapsed_ns, self._turned_ns = now_ns - self._turned_ns, now_ns
        with self._lock:
            jump, self._jump_to = self._jump_to, None
            speed = self._speed
        if jump is not None:
            self._wind(jump, now_ns)
        elif self._winding:
            if now_ns >= self._hushed_until:
                self._winding = False
                self._publish(self._playback.held_at)
        elif speed > 0.0:
            self._play(round(elapsed_ns * speed))
        self._tell(now_ns, at_once=jump is not None)

    def answer(self, command: Command) -> Answer:
        """Play, pause, go to a moment, or end; whoever watches may ask."""
        name, value = command.command, command.value
        with self._lock:
            if name is CommandName.PLAY_REPLAY:
                if not 0.0 <= value <= FASTEST:
                    return Answer(accepted=False, reason=f"a replay runs at 0 (paused) to {FASTEST:g} times its speed")
                if value > 0.0 and self._position >= self._playback.last_ns:
                    self._jump_to = 0.0
                self._speed = value
            elif name is CommandName.JUMP_REPLAY:
                if not 0.0 <= value <= self._playback.seconds + 1.0:
                    length = f"{self._playback.seconds:.1f} s"
                    return Answer(accepted=False, reason=f"the recording is {length} long; go to 0 to {length}")
                self._jump_to = value
            elif name is CommandName.END_REPLAY:
                self.ended = True
            else:
                return Answer(accepted=False, reason="this is a recording; it takes no commands")
        return Answer(accepted=True, reason="", applied_value=value)

    def _play(self, span_ns: int) -> None:
        begin, self._position = self._position, min(self._position + span_ns, self._playback.last_ns)
        self._publish(lambda until_ns: self._playback.between(begin, until_ns))
        if self._position >= self._playback.last_ns:
            with self._lock:
                self._speed = 0.0

    def _wind(self, seconds: float, now_ns: int) -> None:
        """Forwards everything said meanwhile is made up for; backwards all that was said later is void."""
        wanted = min(self._playback.first_ns + round(seconds * 1e9), self._playback.last_ns)
        back, self._position = wanted < self._position, wanted
        if back:
            self._begin_session()
            self._winding, self._hushed_until = True, now_ns + HUSH_NS
        else:
            self._publish(self._playback.held_at)

    def _begin_session(self) -> None:
        self._session += 1
        self._beat()
        self._present()
        self._bus.publish(self._replay_id, topics.REPLAY_MARKS, ReplayMarks(marks=self._marks))

    def _publish(self, choose: Callable[[int], Iterable[Said]]) -> None:
        for said in choose(self._position):
            self._bus.publish(self._replay_id, said.topic, said.message, **said.parts)

    def _tell(self, now_ns: int, *, at_once: bool) -> None:
        if now_ns - self._beat_ns >= BEAT_NS:
            self._beat_ns = now_ns
            self._beat()
        if now_ns - self._presented_ns >= PRESENCE_NS:
            self._presented_ns = now_ns
            self._present()
        if at_once or now_ns - self._told_ns >= TELL_NS:
            self._told_ns = now_ns
            self._bus.publish(self._replay_id, topics.REPLAY, self.state)

    @property
    def state(self) -> ReplayState:
        about = self._playback.recording.about
        return ReplayState(
            stamp_ns=self._position,
            recording=self._playback.recording.path.name,
            robot_id=about.robot_id,
            started=about.started,
            seconds=max(self._position - self._playback.first_ns, 0) * 1e-9,
            length=self._playback.seconds,
            speed=self._speed,
        )

    @property
    def _session_name(self) -> str:
        return f"{self._run}-{self._session}"

    def _beat(self) -> None:
        self._beats += 1
        beat = Heartbeat(stamp_ns=max(self._position, 0), sequence=self._beats, session=self._session_name)
        self._bus.publish(self._replay_id, topics.HEARTBEAT, beat)

    def _present(self) -> None:
        self._bus.publish(self._replay_id, topics.PRESENCE, replace(self._presence, session=self._session_name))
