"""Events in the database: written in batches behind the console's back, read again when it starts."""

from __future__ import annotations

import logging
import sqlite3

from weaver_console.database import Database
from weaver_console.event_log import EventLog, PastEvent
from weaver_shared.messages import Severity

logger = logging.getLogger(__name__)

KEPT = 100_000
"""Older ones are forgotten, a batch at a time."""

_COLUMNS = "time, robot, stamp_ns, severity, source, text"


class EventArchive:
    def __init__(self, database: Database, log: EventLog) -> None:
        self._database = database
        self._log = log
        self._written = 0
        self._failing = False
        for past in reversed(self.latest(before=float("inf"), count=200)):
            self._written = log.restore(past)

    @property
    def behind(self) -> bool:
        """Whether there is something to write."""
        return bool(self._log.since(self._written))

    def flush(self) -> None:
        """Write what came since the last time. A database that fails costs the archive, never the console."""
        events = self._log.since(self._written)
        if not events:
            return
        rows = [(e.time, e.robot, e.stamp_ns, e.severity.value, e.source, e.text) for e in events]
        try:
            self._database.write(f"insert into event ({_COLUMNS}) values (?, ?, ?, ?, ?, ?)", rows)
            self._database.write(
                "delete from event where rowid <= (select max(rowid) from event) - ?", [(KEPT,)]
            )  # rowids grow by one
        except sqlite3.Error as error:
            if not self._failing:
                logger.warning("events are not kept: %s", error)
            self._failing = True
            return
        self._failing = False
        self._written = events[-1].number

    def latest(self, *, before: float, count: int) -> list[PastEvent]:
        """Up to `count` events before the unix time `before` (s), newest first."""
        statement = f"select {_COLUMNS} from event where time < ? order by time desc, rowid desc limit ?"
        return [_event(row) for row in self._database.read(statement, (min(before, 1e12), count))]


def _event(row: tuple[object, ...]) -> PastEvent:
    time, robot, stamp_ns, severity, source, text = row
    return PastEvent(
        robot=str(robot),
        stamp_ns=int(str(stamp_ns)),
        time=float(str(time)),
        severity=Severity(str(severity)),
        source=str(source),
        text=str(text),
    )
