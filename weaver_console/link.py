"""The console's end of the bus: every robot that is there, by itself, with its newest values."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

from weaver_console.event_log import EventLog
from weaver_console.robot_record import RobotRecord
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.clock import Clock, MonotonicClock
from weaver_shared.errors import ConfigurationError
from weaver_shared.messages import Answer, Command, CommandName, Event, Heartbeat, Presence, Severity, TeleopFrame
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.topics import Topic

logger = logging.getLogger(__name__)

WATCHED: tuple[Topic, ...] = (
    topics.STATE,
    topics.GAIT,
    topics.LOCOMOTION,
    topics.ADAPTATION,
    topics.SERVOS,
    topics.POWER,
    topics.HEALTH,
    topics.MAP_TILE,
    topics.CAMERA,
    topics.FEATURES,
    topics.ODOMETRY,
    topics.TERRAIN,
    topics.MODE,
    topics.MOTION,
    topics.LEASE,
    topics.MISSION,
    topics.AREAS,
    topics.OUTLOOK,
    topics.RECORDING,
    topics.REPLAY,
    topics.REPLAY_MARKS,
    topics.CALIBRATION,
    topics.TRUTH,
)
"""Topics whose newest values the console keeps; presence, heartbeat and events are handled on their own."""

PROMPT = frozenset({topics.STATE.key, topics.MODE.key, topics.LEASE.key})
"""Keys of which pages hear at once rather than with their next batch."""

ELSEWHERE = {
    CommandName.START_RECORDING: topics.RECORDER_COMMANDS,
    CommandName.STOP_RECORDING: topics.RECORDER_COMMANDS,
    CommandName.START_REPLAY: topics.RECORDER_COMMANDS,
    CommandName.PLAY_REPLAY: topics.REPLAY_COMMANDS,
    CommandName.JUMP_REPLAY: topics.REPLAY_COMMANDS,
    CommandName.END_REPLAY: topics.REPLAY_COMMANDS,
    CommandName.LOOK_CLOSELY: topics.VISION_COMMANDS,
    CommandName.START_CALIBRATION: topics.CALIBRATOR_COMMANDS,
    CommandName.SOLVE_CALIBRATION: topics.CALIBRATOR_COMMANDS,
    CommandName.END_CALIBRATION: topics.CALIBRATOR_COMMANDS,
}
"""Commands that another process of the robot than the walking one carries out; they need no control of it."""

REPLAYING = "replay"
"""Process that replays a recording as a robot of its own."""

ELSEWHERE_TIMEOUT = 3.0
"""s; those have disks and pictures to wait for."""


class Link:
    """Threads: the bus calls in from its own; pages and scenes read under `lock` or through the methods here."""

    def __init__(self, bus: Bus, *, clock: Clock | None = None, events: EventLog | None = None) -> None:
        self.bus = bus
        self.clock = clock or MonotonicClock()
        self.events = events or EventLog()
        self.lock = threading.RLock()
        self.on_news: Callable[[str], None] = lambda _: None
        """Called with a robot's id, in any thread, when it has said something of which pages hear at once."""
        self._records: dict[str, RobotRecord] = {}
        self._rates_ns = self.clock.now_ns()

    def open(self) -> None:
        """Subscribe to all robots; values come in from now on."""
        self.bus.subscribe("*", topics.PRESENCE, self._receive_presence)
        self.bus.subscribe("*", topics.HEARTBEAT, self._receive_heartbeat)
        self.bus.subscribe("*", topics.EVENT, self._receive_event)
        for topic in WATCHED:
            self.bus.subscribe("*", topic, self._receive)
        self.bus.hear_faults(self._receive_fault)
        self.bus.watch(self._process_changed)

    def close(self) -> None:
        self.bus.close()

    def robots(self) -> list[RobotRecord]:
        with self.lock:
            return [self._records[name] for name in sorted(self._records)]

    def robot(self, robot_id: str) -> RobotRecord | None:
        with self.lock:
            return self._records.get(robot_id)

    def request(self, robot_id: str, command: Command, timeout: float) -> Answer:
        if (query := ELSEWHERE.get(command.command)) is not None:
            return self.bus.ask(robot_id, query, command, ELSEWHERE_TIMEOUT)
        return self.bus.request(robot_id, command, timeout)

    def teleoperate(self, robot_id: str, frame: TeleopFrame) -> None:
        self.bus.publish(robot_id, topics.TELEOP, frame)

    def check(self) -> None:
        """Notice lost and returned robots and measure rates; called about ten times a second."""
        now_ns = self.clock.now_ns()
        with self.lock:
            for record in self.robots():
                self._check_heartbeat(record, now_ns)
                if record.replays and not record.processes and not record.alive:
                    del self._records[record.robot_id]  # a replay that has ended is nobody to wait for
            elapsed = (now_ns - self._rates_ns) * 1e-9
            if elapsed >= 1.0:
                self._rates_ns = now_ns
                for record in self._records.values():
                    record.measure_rates(elapsed)

    def _check_heartbeat(self, record: RobotRecord, now_ns: int) -> None:
        heard = record.heard(now_ns)
        if heard == record.alive:
            return
        record.alive = heard
        if record.replays:
            text = "the replay runs" if heard else "the replay has ended"
            self.events.add(record.robot_id, Severity.INFO, "console", text)
        elif heard:
            self.events.add(record.robot_id, Severity.INFO, "console", f"{record.robot_id} is connected")
        else:
            text = f"{record.robot_id} is lost: no heartbeat for 1 s"
            self.events.add(record.robot_id, Severity.ERROR, "console", text)

    def _record(self, robot_id: str) -> RobotRecord:
        record = self._records.get(robot_id)
        if record is None:
            record = RobotRecord(robot_id=robot_id, first_heard_ns=self.clock.now_ns())
            self._records[robot_id] = record
        return record

    def _receive(self, robot_id: str, key: str, message: Any) -> None:
        with self.lock:
            self._record(robot_id).keep(key, message, self.clock.now_ns())
        if key in PROMPT:
            self.on_news(robot_id)

    def _receive_presence(self, robot_id: str, key: str, presence: Presence) -> None:
        with self.lock:
            record = self._record(robot_id)
            if presence.session in record.former_sessions:
                return
            self._note_restart(record, record.begin_session(presence.session))
            if presence != record.presence:
                record.presence = presence
                record.description = _description(presence.robot)

    def _receive_heartbeat(self, robot_id: str, key: str, heartbeat: Heartbeat) -> None:
        now_ns = self.clock.now_ns()
        with self.lock:
            record = self._record(robot_id)
            conflict = record.conflict(now_ns)
            self._note_restart(record, record.beat(heartbeat, now_ns))
            if not conflict and record.conflict(now_ns):
                self.events.add(robot_id, Severity.ERROR, "console", record.conflict(now_ns))

    def _note_restart(self, record: RobotRecord, restarted: bool) -> None:
        if restarted and not record.replays:  # which begins anew when it is wound back
            text = f"{record.robot_id} has started anew; its map and mission are new"
            self.events.add(record.robot_id, Severity.WARNING, "console", text)

    def _receive_event(self, robot_id: str, key: str, event: Event) -> None:
        self.events.add(robot_id, event.severity, event.source, event.text, stamp_ns=event.stamp_ns)

    def _receive_fault(self, robot_id: str, fault: str) -> None:
        with self.lock:
            record = self._record(robot_id)
            if record.misread(fault, self.clock.now_ns()):
                text = f"{robot_id} can not be understood: {fault}"
                self.events.add(robot_id, Severity.ERROR, "console", text)

    def _process_changed(self, robot_id: str, process: str, came: bool) -> None:
        with self.lock:
            record = self._record(robot_id)
            if came == (process in record.processes):
                return
            if came:
                record.processes.add(process)
            else:
                record.processes.discard(process)
            if process != REPLAYING:  # which is no loss, and tells of itself
                severity, word = (Severity.INFO, "there") if came else (Severity.ERROR, "gone")
                self.events.add(robot_id, severity, "console", f"process {process} of {robot_id} is {word}")


def _description(name: str) -> RobotDescription | None:
    try:
        return load_robot(name)
    except ConfigurationError as error:
        logger.warning("a robot is shown without its figure: %s", error)
        return None
