"""What the console knows of one robot: its newest values, who it is and whether it is heard."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import takewhile
from typing import Any, TypeVar

from weaver_console.plain import plain, to_json
from weaver_console.scene.ground import Ground
from weaver_shared import topics
from weaver_shared.messages import Heartbeat, LeaseState, MapTile, MissionState, ModeState, Presence
from weaver_shared.robots import RobotDescription

M = TypeVar("M")

REPLAY = "REPLAY"
"""The kind under which a replay presents itself."""

HEARTBEAT_TIMEOUT_NS = 1_000_000_000
"""Silence after which a robot counts as lost."""

LAST_WORDS_NS = 100_000_000
"""How long after its last heartbeat a robot that died may still be heard."""

FAULT_NS = 5_000_000_000
"""How long a message that could not be read is told of."""

CONFLICT_NS = 2_000_000_000
"""How long a second robot with the same id is reported after its last heartbeat."""


class Value:
    """The newest message of a key. `version` grows with every message of the robot, so readers see what is new."""

    __slots__ = ("_json", "key", "message", "received_ns", "version")

    def __init__(self, *, key: str, message: Any, received_ns: int, version: int) -> None:
        self.key = key
        self.message = message
        self.received_ns = received_ns
        self.version = version
        self._json: bytes | None = None

    @property
    def json(self) -> bytes:
        """Encoded once, however many pages watch."""
        if self._json is None:
            self._json = to_json(plain(self.message))
        return self._json


@dataclass(slots=True)
class RobotRecord:
    robot_id: str
    first_heard_ns: int
    presence: Presence | None = None
    description: RobotDescription | None = None
    processes: set[str] = field(default_factory=set)
    values: dict[str, Value] = field(default_factory=dict)
    ground: Ground = field(default_factory=Ground)
    session: str = ""
    heartbeat_ns: int | None = None
    alive: bool = False
    former_sessions: set[str] = field(default_factory=set)
    intruder_ns: int | None = None
    fault: str = ""  # what was wrong with the last message that could not be read, and when it came
    fault_ns: int | None = None
    generation: int = 0  # counts the robot's starts; values of former ones are void
    version: int = 0
    counts: dict[str, int] = field(default_factory=dict)  # messages received by key since the last rates
    rates: dict[str, float] = field(default_factory=dict)  # Hz by key
    loss: float | None = None  # share of its heartbeats that did not arrive
    beat_stamp_ns: int = 0  # robot's clock in its newest heartbeat
    counted_stamp_ns: int = 0  # the same when loss was last measured

    def keep(self, key: str, message: Any, now_ns: int) -> None:
        self.version += 1
        self.values.pop(key, None)  # so that they stay in the order of their versions
        self.values[key] = Value(key=key, message=message, received_ns=now_ns, version=self.version)
        self.counts[key] = self.counts.get(key, 0) + 1
        if isinstance(message, MapTile):
            self.ground.put(message)

    def since(self, version: int) -> list[Value]:
        """Values newer than this version, newest first."""
        return list(takewhile(lambda value: value.version > version, reversed(self.values.values())))

    def beat(self, heartbeat: Heartbeat, now_ns: int) -> bool:
        """Count a heartbeat; True when it is the first of a new session of the robot."""
        if heartbeat.session in self.former_sessions:
            self.intruder_ns = now_ns
            return False
        restarted = self.begin_session(heartbeat.session)
        self.heartbeat_ns = now_ns
        self.beat_stamp_ns = heartbeat.stamp_ns
        self.counts["hb"] = self.counts.get("hb", 0) + 1
        return restarted

    def begin_session(self, session: str) -> bool:
        """Forget what a former start of the robot said; True if it was another start."""
        if session == self.session or session in self.former_sessions:
            return False
        restarted = bool(self.session)
        if restarted:
            self.former_sessions.add(self.session)
            self._forget_former()
            self.generation += 1
        self.session = session
        return restarted

    def _forget_former(self) -> None:
        """Drop what the former start can have said; a new one may speak before its first heartbeat is heard."""
        last_ns = (self.heartbeat_ns or 0) + LAST_WORDS_NS
        self.values = {key: value for key, value in self.values.items() if value.received_ns > last_ns}
        self.ground = Ground()
        for value in self.values.values():
            if isinstance(value.message, MapTile):
                self.ground.put(value.message)

    def measure_rates(self, elapsed: float) -> None:
        """Turn the counts of the last `elapsed` s into rates and loss.

        Heartbeats are sent by the robot's clock: how many there were is told by their stamps, however slow it runs.
        """
        sent = (self.beat_stamp_ns - self.counted_stamp_ns) * 1e-9 * topics.HEARTBEAT.rate
        known = self.counted_stamp_ns > 0 and sent >= 1.0 and not self.replays  # which winds and pauses its clock
        self.loss = max(0.0, 1.0 - self.counts.get("hb", 0) / sent) if known else None
        self.counted_stamp_ns = self.beat_stamp_ns
        self.rates = {key: count / elapsed for key, count in self.counts.items()}
        self.counts = dict.fromkeys(self.counts, 0)

    def heartbeat_age(self, now_ns: int) -> float | None:
        """Seconds since the last heartbeat, None before the first."""
        return None if self.heartbeat_ns is None else (now_ns - self.heartbeat_ns) * 1e-9

    def heard(self, now_ns: int) -> bool:
        return self.heartbeat_ns is not None and now_ns - self.heartbeat_ns < HEARTBEAT_TIMEOUT_NS

    def misread(self, fault: str, now_ns: int) -> bool:
        """Note that something it said could not be read; True when that is news."""
        news = self.fault_ns is None or now_ns - self.fault_ns > FAULT_NS
        self.fault, self.fault_ns = fault, now_ns
        return news

    def conflict(self, now_ns: int) -> str:
        """What is wrong with who this robot is, in a sentence; empty when all is well."""
        if self.fault_ns is not None and now_ns - self.fault_ns < FAULT_NS:
            return f"{self.robot_id} can not be understood: {self.fault}"
        if self.intruder_ns is None or now_ns - self.intruder_ns > CONFLICT_NS:
            return ""
        return f"two robots answer to the id {self.robot_id!r}; stop one of them or start it with another id"

    @property
    def replays(self) -> bool:
        """Whether this is a recording that is being replayed, and no robot."""
        return self.presence is not None and self.presence.kind == REPLAY

    @property
    def mode(self) -> ModeState | None:
        return self.newest("state/mode", ModeState)

    @property
    def lease(self) -> LeaseState | None:
        return self.newest("state/lease", LeaseState)

    @property
    def mission(self) -> MissionState | None:
        return self.newest("state/mission", MissionState)

    def newest(self, key: str, kind: type[M]) -> M | None:
        value = self.values.get(key)
        return value.message if value is not None and isinstance(value.message, kind) else None
