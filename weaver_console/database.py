"""The console's one SQLite file: missions by name, every event with who caused it, and the users."""

from __future__ import annotations

import os
import sqlite3
import threading
from collections.abc import Iterable
from pathlib import Path

from weaver_shared.errors import ResourceError

VERSION = 2
BUSY = 5.0
"""s to wait for another console that writes to the same file."""

_TABLES = """
create table mission (
    name text primary key, waypoints text not null, operator text not null, robot text not null, saved real not null
) strict;
create table event (
    time real not null, robot text not null, stamp_ns integer not null, severity text not null, source text not null,
    text text not null
) strict;
create index event_time on event (time);
"""

_USERS = """
create table user (
    name text primary key, role text not null, password text not null, added real not null
) strict;
create table session (digest text primary key, user text not null, expires real not null) strict;
create table token (digest text primary key, user text not null, added real not null) strict;
"""
"""New with version 2. Of secrets only digests are kept."""


def data_folder() -> Path:
    """Where the console keeps its data unless told otherwise, by the XDG base directory specification."""
    root = os.environ.get("XDG_DATA_HOME", "")
    return (Path(root) if root else Path.home() / ".local" / "share") / "weaver-console"


class Database:
    """Safe to use from several threads. Raises ResourceError on a file that can not be used, with the reason."""

    def __init__(self, path: Path | None) -> None:
        """`path` of the file, made with its folder where it is missing; None keeps everything in memory."""
        self._lock = threading.Lock()
        self._where = str(path) if path is not None else ":memory:"
        try:
            if path is not None:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.touch(mode=0o600)  # its passwords are hashed, but nobody else's business
            self._connection = sqlite3.connect(self._where, timeout=BUSY, check_same_thread=False)
            self._prepare()
        except (OSError, sqlite3.Error) as error:
            raise ResourceError(f"the database {self._where} can not be used: {error}; give another --data") from error

    def close(self) -> None:
        with self._lock:
            self._connection.close()

    def read(self, statement: str, values: Iterable[object] = ()) -> list[tuple[object, ...]]:
        with self._lock:
            return self._connection.execute(statement, tuple(values)).fetchall()

    def write(self, statement: str, rows: Iterable[Iterable[object]]) -> int:
        """Run for every row, all or none; returns how many rows changed."""
        with self._lock, self._connection:
            return self._connection.executemany(statement, [tuple(row) for row in rows]).rowcount

    def _prepare(self) -> None:
        # NOTE: the write-ahead log loses at most the last moment in a power cut, and never the file.
        self._connection.execute("pragma journal_mode = wal")
        self._connection.execute("pragma synchronous = normal")
        (version,) = self._connection.execute("pragma user_version").fetchone()
        if version == 0:
            self._connection.executescript(f"begin; {_TABLES} {_USERS} pragma user_version = {VERSION}; commit;")
        elif version == 1:
            self._connection.executescript(f"begin; {_USERS} pragma user_version = {VERSION}; commit;")
        elif version != VERSION:
            self._connection.close()
            raise ResourceError(
                f"the database {self._where} is of version {version}, this console reads {VERSION}; give another --data"
            )
