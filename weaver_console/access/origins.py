"""Where a request may come from: our own page, or a program that is no browser."""

from __future__ import annotations

import ipaddress
from collections.abc import Mapping


def is_loopback(host: str) -> bool:
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def origin_allowed(headers: Mapping[str, str], *, loopback: bool, sandboxed: bool = False) -> bool:
    """Whether a request comes from our own page, or from a program that is no browser.

    On `loopback` the host itself must be a loopback name: another site's name may be pointed at this computer.
    `sandboxed` requests may come from a frame without an origin.
    """
    host = headers.get("host", "")
    if loopback and not is_loopback(_without_port(host)):
        return False
    origin = headers.get("origin")
    return origin is None or (sandboxed and origin == "null") or origin.split("://", 1)[-1] == host


def _without_port(host: str) -> str:
    if host.startswith("["):
        return host[1:].partition("]")[0]
    return host.partition(":")[0]
