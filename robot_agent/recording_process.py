"""The robot's recorder: begins and ends recordings as it is told, and says on the bus what it is doing."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime

from robot_agent.recording import Recorder, RecordingWriter
from robot_agent.recording.store import RecordingStore
from robot_agent.replays import Replays
from robot_agent.waiting_orders import WaitingOrders
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.clock import Clock
from weaver_shared.errors import ResourceError, WeaverError
from weaver_shared.messages import Answer, Command, CommandName, Event, RecordingState, Severity
from weaver_shared.robots import RobotDescription

LEAST_FREE = 500_000_000
"""B on the disk below which nothing is recorded: the robot needs some to live."""

TELL_NS = 1_000_000_000


@dataclass(slots=True, kw_only=True)
class _Running:
    """A recording that runs, with the bus it listens on: closed with it, so that nothing is heard in between."""

    bus: Bus
    writer: RecordingWriter
    recorder: Recorder
    pictures: bool


class RecordingProcess:
    """`turn` does all the work; commands come in on the bus's threads and wait for it."""

    def __init__(
        self,
        *,
        robot_id: str,
        robot: RobotDescription,
        bus: Bus,
        open_bus: Callable[[], Bus],
        store: RecordingStore,
        replays: Replays,
        clock: Clock,
        wall_time: Callable[[], datetime],
    ) -> None:
        self._robot_id = robot_id
        self._robot = robot
        self._bus = bus
        self._open_bus = open_bus
        self._store = store
        self._replays = replays
        self._clock = clock
        self._wall_time = wall_time
        self._orders = WaitingOrders()
        self._running: _Running | None = None
        self._reason = ""
        self._stamp_ns = 0
        self._told_ns = -TELL_NS
        bus.answer_queries(robot_id, topics.RECORDER_COMMANDS, self._orders.ask)
        bus.answer_queries(robot_id, topics.RECORDING_PART, store.part)
        bus.announce(robot_id, "recorder")
        self._tell()

    def run(self, ended: threading.Event) -> None:
        while not ended.is_set():
            self.turn(0.1)
        self.close()

    def turn(self, wait: float = 0.0) -> None:
        """Carry out orders, write what was said; `wait` at most so many s for something to do."""
        self._orders.carry_out(self._carry_out)
        if self._running is None:
            self._orders.wait(wait)
        else:
            try:
                self._running.recorder.turn(wait)
                self._look_after(self._running)
            except WeaverError as error:
                self._end(str(error))
        if self._clock.now_ns() - self._told_ns >= TELL_NS:
            self._tell()

    def close(self) -> None:
        """End the recording that runs, if any; its file is whole afterwards. Replays end too."""
        if self._running is not None:
            self._end("")
        self._replays.close()

    def _carry_out(self, command: Command) -> Answer:
        try:
            if command.command is CommandName.START_RECORDING:
                self._begin(pictures=command.value != 0.0)
                text = "start recording" + ("" if command.value else " without pictures")
            elif command.command is CommandName.STOP_RECORDING:
                if self._running is None:
                    raise ResourceError("nothing is being recorded")
                text = f"stop recording {self._running.writer.path.name}"
                self._end("")
            elif command.command is CommandName.START_REPLAY:
                text = f"replay {self._replay(command.name)}"
            else:
                raise ResourceError(f"the recorder does not know {command.command.value}")
        except WeaverError as error:
            text = f"{command.command.value.replace('_', ' ')}: refused, {error}"
            self._note(Severity.WARNING, text, command.operator)
            return Answer(accepted=False, reason=str(error))
        self._note(Severity.INFO, text, command.operator)
        return Answer(accepted=True, reason="", applied_value=command.value)

    def _replay(self, name: str) -> str:
        """Raises ResourceError that says why not."""
        if self._running is not None and name == self._running.writer.path.name:
            raise ResourceError(f"{name} is still being recorded; stop the recording first")
        self._replays.begin(self._store.path(name))
        return name

    def _begin(self, *, pictures: bool) -> None:
        """Raises ResourceError that says what is in the way."""
        if self._running is not None:
            raise ResourceError(f"{self._running.writer.path.name} is being recorded already")
        self._require_room()
        started = self._wall_time()
        writer = RecordingWriter(
            self._store.new_path(self._robot_id, started),
            robot_id=self._robot_id,
            robot=self._robot,
            clock=self._clock,
            started=started.isoformat(timespec="seconds"),
            pictures=pictures,
        )
        bus = self._open_bus()
        recorder = Recorder(bus, self._robot_id, writer, pictures=pictures)
        self._running = _Running(bus=bus, writer=writer, recorder=recorder, pictures=pictures)
        self._reason = ""
        self._tell()

    def _look_after(self, running: _Running) -> None:
        """Stop before the disk is full, and begin anew where the robot did."""
        if self._clock.now_ns() - self._told_ns >= TELL_NS:
            self._require_room()
        if running.recorder.restarted:
            self._end("the robot was started anew")
            self._begin(pictures=running.pictures)

    def _require_room(self) -> None:
        free = self._store.free()
        if free < LEAST_FREE:
            raise ResourceError(
                f"the robot's disk has {free / 1e6:.0f} MB left; recording needs {LEAST_FREE / 1e6:.0f} MB to begin"
            )

    def _end(self, reason: str) -> None:
        running, self._running = self._running, None
        if running is None:
            return
        running.bus.close()
        self._stamp_ns = running.writer.newest_ns
        try:
            if not reason:
                running.recorder.turn()
            running.writer.close()
        except WeaverError as error:
            reason = reason or str(error)
        self._reason = reason
        if reason:
            self._note(Severity.WARNING, f"the recording {running.writer.path.name} has ended: {reason}", "recorder")
        self._tell()

    def _tell(self) -> None:
        running = self._running
        self._told_ns = self._clock.now_ns()
        state = RecordingState(
            active="" if running is None else running.writer.path.name,
            seconds=0.0 if running is None else running.writer.seconds,
            size=0 if running is None else running.writer.size,
            pictures=running is not None and running.pictures,
            lost=0 if running is None else running.recorder.lost,
            reason=self._reason,
            folder=str(self._store.folder.absolute()),
            free=self._store.free(),
            entries=self._store.entries("" if running is None else running.writer.path.name),
        )
        self._bus.publish(self._robot_id, topics.RECORDING, state)

    def _note(self, severity: Severity, text: str, source: str) -> None:
        stamp_ns = self._stamp_ns if self._running is None else self._running.writer.newest_ns
        self._bus.publish(
            self._robot_id, topics.EVENT, Event(stamp_ns=stamp_ns, severity=severity, source=source, text=text)
        )
