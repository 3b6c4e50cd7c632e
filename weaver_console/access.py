"""Who may use the console: the password off loopback, its cookie, and the origins a browser may come from."""

from __future__ import annotations

import hashlib
import hmac
import ipaddress
import time
from collections import deque
from collections.abc import Callable, Mapping

from weaver_shared.errors import ConfigurationError

COOKIE = "weaver_console"
VALID_S = 12 * 3600
MOST_FAILURES = 10
FAILURE_WINDOW_S = 60.0


def is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Access:
    """Raises ConfigurationError when the console would be open to other computers without a password."""

    def __init__(self, *, host: str, password: str = "", now: Callable[[], float] = time.time) -> None:
        if not is_loopback(host) and not password:
            raise ConfigurationError(
                f"the console does not listen on {host} without a password; give --password-file, or --host 127.0.0.1"
            )
        self._loopback = is_loopback(host)
        self._now = now
        self._password = password
        self._failures: deque[float] = deque(maxlen=MOST_FAILURES)
        # Derived from the password alone, so that a restarted console still knows who has logged in.
        self._key = hashlib.scrypt(password.encode(), salt=b"weaver console cookie", n=2**12, r=8, p=1)

    @property
    def open(self) -> bool:
        """Whether no password is needed."""
        return not self._password

    @property
    def blocked(self) -> bool:
        """Whether too many wrong passwords came within the last minute."""
        full = len(self._failures) == MOST_FAILURES
        return full and self._now() - self._failures[0] < FAILURE_WINDOW_S

    def check_password(self, password: str) -> bool:
        right = hmac.compare_digest(password.encode(), self._password.encode())
        if not right:
            self._failures.append(self._now())
        return right

    def issue_cookie(self) -> str:
        expiry = str(int(self._now()) + VALID_S)
        return f"{expiry}.{self._sign(expiry)}"

    def admits(self, cookie: str | None) -> bool:
        """Whether a request with this cookie may pass."""
        if self.open:
            return True
        expiry, _, signature = (cookie or "").partition(".")
        if not hmac.compare_digest(signature.encode(), self._sign(expiry).encode()):
            return False
        return expiry.isdecimal() and int(expiry) > self._now()

    def origin_allowed(self, headers: Mapping[str, str], *, sandboxed: bool = False) -> bool:
        """Whether a request comes from our own page, or from a program that is no browser.

        On loopback the host itself must be a loopback name: another site's name may be pointed at this computer.
        `sandboxed` requests may come from a frame without an origin.
        """
        host = headers.get("host", "")
        if self._loopback and not is_loopback(_without_port(host)):
            return False
        origin = headers.get("origin")
        return origin is None or (sandboxed and origin == "null") or origin.split("://", 1)[-1] == host

    def _sign(self, expiry: str) -> str:
        return hmac.new(self._key, expiry.encode(), hashlib.sha256).hexdigest()


def _without_port(host: str) -> str:
    if host.startswith("["):
        return host[1:].partition("]")[0]
    return host.partition(":")[0]
