"""Events outlive the console, in order and with who caused them, and a full disk stops nobody."""

import sqlite3
from pathlib import Path

import pytest
from running_console import Console

from weaver_console import event_archive
from weaver_console.database import Database
from weaver_console.event_archive import EventArchive
from weaver_console.event_log import EventLog
from weaver_shared.messages import Severity


def _log(begin: float = 0.0) -> EventLog:
    times = (begin + k for k in range(1000))
    return EventLog(lambda: next(times))


def test_the_next_console_begins_with_the_last_events(tmp_path: Path) -> None:
    first, log = Database(tmp_path / "a.sqlite3"), _log()
    archive = EventArchive(first, log)
    for k in range(250):
        log.add("sim-1", Severity.WARNING, "anna", f"event {k}", stamp_ns=k)
        if k % 40 == 0:
            archive.flush()
    assert archive.behind
    archive.flush()
    assert not archive.behind
    first.close()
    second, later = Database(tmp_path / "a.sqlite3"), _log(1000.0)
    again = EventArchive(second, later)
    assert not again.behind
    assert [event.text for event in later.latest()] == [f"event {k}" for k in range(50, 250)]
    last = later.latest(1)[0]
    assert (last.robot, last.severity, last.source, last.stamp_ns, last.time) == (
        "sim-1", Severity.WARNING, "anna", 249, 249.0,
    )  # fmt: skip
    later.add("", Severity.INFO, "console", "new")
    again.flush()
    assert [event.text for event in again.latest(before=1e9, count=2)] == ["new", "event 249"]
    assert [event.text for event in again.latest(before=3.0, count=9)] == ["event 2", "event 1", "event 0"]
    second.close()


def test_old_events_make_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(event_archive, "KEPT", 10)
    log = _log()
    archive = EventArchive(Database(None), log)
    for k in range(25):
        log.add("", Severity.INFO, "console", f"event {k}")
        archive.flush()
    assert [event.text for event in archive.latest(before=1e9, count=99)] == [f"event {k}" for k in range(24, 14, -1)]


def test_a_database_that_fails_loses_nothing_that_comes_back(monkeypatch: pytest.MonkeyPatch) -> None:
    log = _log()
    database = Database(None)
    archive = EventArchive(database, log)
    log.add("", Severity.INFO, "console", "kept later")
    with monkeypatch.context() as broken:
        broken.setattr(database, "write", _full)
        archive.flush()
    assert archive.behind
    archive.flush()
    assert [event.text for event in archive.latest(before=1e9, count=9)] == ["kept later"]


def test_past_events_over_http(console: Console) -> None:
    console.hub.link.events.add("sim-1", Severity.ERROR, "anna", "it fell")
    console.hub.archive.flush()
    (event,) = console.http.get("/api/events", params={"count": 5}).json()["events"]
    assert (event["robot"], event["severity"], event["source"], event["text"]) == ("sim-1", "error", "anna", "it fell")
    for bad in ({"count": 0}, {"count": 100000}, {"before": "nan"}, {"before": "soon"}):
        assert console.http.get("/api/events", params=bad).status_code == 422


def _full(*_: object) -> int:
    raise sqlite3.OperationalError("database or disk is full")
