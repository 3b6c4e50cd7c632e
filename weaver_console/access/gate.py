"""The console's gate: who a request is from, by cookie or token, and whether it may come in at all."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

from weaver_console.access import origins
from weaver_console.access.rate_limit import RateLimit
from weaver_console.access.roles import OPEN, Identity
from weaver_console.access.sessions import COOKIE, SessionStore
from weaver_console.access.users import UserStore
from weaver_console.database import Database
from weaver_shared.errors import ConfigurationError

MOST_FAILURES = 10
FAILURE_WINDOW_S = 60.0
MOST_FAILURES_OF_ALL = 100
"""Wrong passwords in a window from one address, and from all of them."""


class Access:
    """On loopback nobody needs to log in, unless `guarded`: behind a proxy everybody comes from there.

    Raises ConfigurationError when the console would be open to other computers without users.
    """

    def __init__(
        self,
        *,
        host: str,
        database: Database | None = None,
        guarded: bool = False,
        now: Callable[[], float] = time.time,
    ) -> None:
        database = database or Database(None)
        self.users = UserStore(database, now)
        self._sessions = SessionStore(database, now)
        loopback = origins.is_loopback(host)
        self.open = loopback and not guarded
        """Whether nobody needs to log in."""
        if not self.open and not self.users.exist:
            raise ConfigurationError(
                f"the console is not opened on {host} without users; add one with "
                "`weaver console user add NAME --role admin`, or use --host 127.0.0.1"
            )
        each = MOST_FAILURES / FAILURE_WINDOW_S
        self._failures = RateLimit(rate=each, burst=MOST_FAILURES, now=now)
        self._all_failures = RateLimit(rate=10 * each, burst=MOST_FAILURES_OF_ALL, now=now)

    def blocked(self, address: str) -> bool:
        """Whether too many wrong passwords came from there, or from everywhere, within the last minute."""
        return self._failures.exhausted(address) or self._all_failures.exhausted("")

    def log_in(self, name: str, password: str, address: str) -> tuple[Identity, str] | None:
        """The user and a new session's secret, if this is their password. Takes some 50 ms."""
        user = self.users.check(name, password)
        if user is None:
            self._failures.spend(address)
            self._all_failures.spend("")
            return None
        return user, self._sessions.begin(user.name)

    def log_out(self, cookies: Mapping[str, str]) -> None:
        if secret := cookies.get(COOKIE):
            self._sessions.end(secret)

    def identify(self, headers: Mapping[str, str], cookies: Mapping[str, str]) -> Identity | None:
        """Who this request is from; None when they have to log in first."""
        if self.open:
            return OPEN
        kind, _, token = headers.get("authorization", "").partition(" ")
        if kind.lower() == "bearer":
            return self.users.by_token(token.strip())
        user = self._sessions.user(cookies.get(COOKIE, ""))
        return self.users.find(user) if user is not None else None

    def origin_allowed(self, headers: Mapping[str, str], *, sandboxed: bool = False) -> bool:
        return origins.origin_allowed(headers, loopback=self.open, sandboxed=sandboxed)
