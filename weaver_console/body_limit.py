"""Requests with a body larger than any of ours are refused before they fill the memory."""

from __future__ import annotations

import contextlib
import json
from typing import Any

LARGEST_BODY = 256 * 1024

Scope = dict[str, Any]


class BodyLimit:
    """ASGI middleware: 413 at once when the length is told, and as soon as more comes when it is not."""

    def __init__(self, app: Any) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Any, send: Any) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        told = dict(scope["headers"]).get(b"content-length", b"0")
        if not told.isdigit() or int(told[:20]) > LARGEST_BODY:
            await _refuse(send)
            return
        come = 0

        async def next_part() -> dict[str, Any]:
            nonlocal come
            message: dict[str, Any] = await receive()
            come += len(message.get("body", b""))
            if come > LARGEST_BODY:
                raise _TooLargeError
            return message

        async def passed_on(message: dict[str, Any]) -> None:
            # The application may have made an answer of its own of the broken body.
            if come <= LARGEST_BODY:
                await send(message)

        with contextlib.suppress(_TooLargeError):
            await self._app(scope, next_part, passed_on)
        if come > LARGEST_BODY:
            await _refuse(send)


class _TooLargeError(Exception):
    pass


async def _refuse(send: Any) -> None:
    body = json.dumps({"error": f"a request may have {LARGEST_BODY // 1024} kB"}).encode()
    headers = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": 413, "headers": headers})
    await send({"type": "http.response.body", "body": body})
