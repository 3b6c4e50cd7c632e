"""A request too large for any of ours is refused, whether it tells its length or not."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from weaver_console.body_limit import LARGEST_BODY, BodyLimit

PART = 64 * 1024


class Upload:
    """One request in parts, and an application that reads it all before it answers 200."""

    def __init__(self, parts: list[int], told: bytes | None = None) -> None:
        self._parts = iter([*({"type": "http.request", "body": bytes(n), "more_body": True} for n in parts), {}])
        self._headers = [] if told is None else [(b"content-length", told)]
        self.read = 0
        self.finished = False
        self.sent: list[dict[str, Any]] = []

    def run(self) -> int:
        scope = {"type": "http", "headers": self._headers}
        asyncio.run(BodyLimit(self._application)(scope, self._receive, self._send))
        return int(self.sent[0]["status"])

    async def _receive(self) -> dict[str, Any]:
        return next(self._parts)

    async def _send(self, message: dict[str, Any]) -> None:
        self.sent.append(message)

    async def _application(self, _scope: Any, receive: Any, send: Any) -> None:
        while message := await receive():
            self.read += len(message["body"])
        self.finished = True
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b""})


def test_a_length_too_large_is_refused_before_anything_is_read():
    upload = Upload([PART] * 5, told=b"%d" % (5 * PART))
    assert (upload.run(), upload.read) == (413, 0)


@pytest.mark.parametrize("told", [b"-1", b"many", b"9" * 400])
def test_a_length_that_is_none_is_refused(told: bytes):
    assert Upload([1], told=told).run() == 413


def test_a_body_without_a_length_is_cut_off_where_it_becomes_too_large():
    upload = Upload([PART] * 64)
    assert upload.run() == 413
    assert not upload.finished
    assert upload.read <= LARGEST_BODY
    assert [message["type"] for message in upload.sent] == ["http.response.start", "http.response.body"]


def test_the_largest_allowed_body_comes_through():
    upload = Upload([PART] * (LARGEST_BODY // PART))
    assert (upload.run(), upload.read) == (200, LARGEST_BODY)
