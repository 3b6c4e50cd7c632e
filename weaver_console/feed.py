"""What is new for one page since it was last told: values by newest-wins, events in order, the list of robots.

The page's sender asks when it is ready, so a slow page skips values and holds up nobody.
"""

from __future__ import annotations

from functools import lru_cache

from weaver_console.link import Link
from weaver_console.plain import to_json
from weaver_console.robot_record import RobotRecord, Value
from weaver_console.roster import Roster

PERIODS_NS = {
    "tele/state": 33_000_000,
    "tele/gait": 100_000_000,
    "tele/locomotion": 200_000_000,
    "tele/adaptation": 100_000_000,
    "tele/power": 200_000_000,
    "tele/servos": 500_000_000,
    "tele/health/": 400_000_000,
    "tele/odometry": 200_000_000,
    "tele/terrain": 200_000_000,
    "truth/state": 100_000_000,
    "tele/map/tile/": 200_000_000,
    "tele/cam/": 200_000_000,
    "tele/features/": 200_000_000,
}
"""Least time between two values of a key, by the key's beginning; others go at once."""

CAMERAS, FEATURES = "tele/cam/", "tele/features/"
BULK = ("tele/map/", CAMERAS)
LARGEST_BATCH = 256 * 1024
"""Bytes after which further tiles and pictures wait for the next batch unless less is asked for; the rest goes before
them and always.
"""

LINK_PERIOD_NS = 500_000_000
SLACK_NS = 5_000_000
"""A value this close to being due is sent now rather than a whole tick later."""


class Feed:
    def __init__(self, link: Link, roster: Roster) -> None:
        self._link = link
        self._roster = roster
        self._roster_version = -1
        self._event_number = 0
        self._generation = 0
        self._seen = 0
        self._waiting: dict[str, None] = {}  # keys with something new, those that wait longest first
        self._due_ns: dict[str, int] = {}
        self._link_due_ns = 0
        self.robot: str | None = None
        self.cameras = self.features = False
        self.bulk = 0  # bytes of tiles and pictures in the last batch

    def select(self, robot: str | None) -> None:
        record = self._link.robot(robot) if robot is not None else None
        self.robot = robot
        self._seen, self._waiting, self._due_ns = 0, {}, {}
        self._link_due_ns = 0
        self._generation = record.generation if record else 0

    def past_events(self) -> bytes:
        """The last events at once; later ones come one by one."""
        events = self._link.events.latest()
        self._event_number = events[-1].number if events else 0
        return to_json({"type": "events", "events": [event.to_page() for event in events]})

    def collect(self, room: int = LARGEST_BATCH) -> list[bytes]:
        """Encoded messages that are new and due now, with up to `room` bytes (and one more) of tiles and pictures."""
        now_ns = self._link.clock.now_ns()
        messages: list[bytes] = []
        self.bulk = 0
        if self._roster_version != self._roster.version:
            self._roster_version = self._roster.version
            messages.append(self._roster.json)
        for event in self._link.events.since(self._event_number):
            self._event_number = event.number
            messages.append(to_json({"type": "event", **event.to_page()}))
        record = self._link.robot(self.robot) if self.robot is not None else None
        if record is not None:
            messages += self._robot_messages(record, now_ns, room)
        return messages

    def _robot_messages(self, record: RobotRecord, now_ns: int, room: int) -> list[bytes]:
        messages = []
        with self._link.lock:
            if record.generation != self._generation:
                self._generation = record.generation
                self._seen, self._waiting, self._due_ns = 0, {}, {}
                messages.append(to_json({"type": "forget", "robot": record.robot_id, "keys": ["*"]}))
            for value in reversed(record.since(self._seen)):
                self._waiting.setdefault(value.key)
                self._seen = value.version
            values = [record.values[key] for key in self._waiting if self._wanted(key, now_ns)]
        messages += self._values(record.robot_id, values, now_ns, room)
        if now_ns >= self._link_due_ns:
            self._link_due_ns = now_ns + LINK_PERIOD_NS
            messages.append(to_json(_link_message(record, now_ns)))
        return messages

    def _values(self, robot: str, values: list[Value], now_ns: int, room: int) -> list[bytes]:
        messages = []
        for value in sorted(values, key=lambda value: value.key.startswith(BULK)):
            bulky = value.key.startswith(BULK)
            if bulky and self.bulk >= room:
                break
            message = _value_message(robot, value, now_ns)
            del self._waiting[value.key]
            self._due_ns[value.key] = now_ns + _period_ns(value.key)
            messages.append(message)
            self.bulk += len(message) if bulky else 0
        return messages

    def _wanted(self, key: str, now_ns: int) -> bool:
        due = now_ns + SLACK_NS >= self._due_ns.get(key, 0)
        if key.startswith(FEATURES):
            return due and self.features
        return due and (self.cameras or not key.startswith(CAMERAS))


@lru_cache(maxsize=4096)
def _period_ns(key: str) -> int:
    for beginning, period in PERIODS_NS.items():
        if key.startswith(beginning):
            return period
    return 0


def _value_message(robot: str, value: Value, now_ns: int) -> bytes:
    head = {
        "type": "value",
        "robot": robot,
        "key": value.key,
        "kind": type(value.message).__name__,
        "stamp_ns": getattr(value.message, "stamp_ns", 0),
        "age_s": round((now_ns - value.received_ns) * 1e-9, 4),
    }
    return to_json(head)[:-1] + b',"value":' + value.json + b"}"


def _link_message(record: RobotRecord, now_ns: int) -> dict[str, object]:
    age = record.heartbeat_age(now_ns)
    return {
        "type": "link",
        "robot": record.robot_id,
        "alive": record.alive,
        "heartbeat_age_s": None if age is None else round(age, 3),
        "loss": None if record.loss is None else round(record.loss, 3),
        "rates": {key: round(rate, 1) for key, rate in record.rates.items() if "/tile/" not in key},
    }
