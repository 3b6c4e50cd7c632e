"""Who has logged in, until when: kept in the database, so that a restarted console still knows."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable

from weaver_console.access.users import digest_of
from weaver_console.database import Database

COOKIE = "weaver_console"
VALID_S = 12 * 3600
"""A working day."""


class SessionStore:
    def __init__(self, database: Database, now: Callable[[], float] = time.time) -> None:
        self._database = database
        self._now = now

    def begin(self, user: str) -> str:
        """The secret for the cookie."""
        secret = secrets.token_urlsafe(32)
        self._database.write("delete from session where expires < ?", [(self._now(),)])
        self._database.write("insert into session values (?, ?, ?)", [(digest_of(secret), user, self._now() + VALID_S)])
        return secret

    def user(self, secret: str) -> str | None:
        """Whose session this is; None when it has expired, was ended, or never was."""
        rows = self._database.read(
            "select user from session where digest = ? and expires > ?", (digest_of(secret), self._now())
        )
        return str(rows[0][0]) if rows else None

    def end(self, secret: str) -> None:
        self._database.write("delete from session where digest = ?", [(digest_of(secret),)])
