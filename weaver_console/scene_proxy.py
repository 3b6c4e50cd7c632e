"""Carries the 3-D view's connection between the browser and the viser server that draws for that page."""

from __future__ import annotations

import asyncio
import contextlib
import logging

import websockets
from fastapi import WebSocket, WebSocketDisconnect
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

logger = logging.getLogger(__name__)

_REFUSED = (b"ShareUrlRequest", b"ShareUrlDisconnect")
"""Messages that would open a tunnel to a public server."""


async def carry(browser: WebSocket, port: int) -> None:
    """Pump both ways until either end closes."""
    offered = browser.scope.get("subprotocols", [])
    chosen = next((name for name in offered if name.startswith("viser-v")), None)
    if chosen is None:
        await browser.close(code=1002, reason="not a viser page")
        return
    try:
        upstream = await connect(
            f"ws://127.0.0.1:{port}", subprotocols=[Subprotocol(chosen)], compression=None, max_size=None, proxy=None
        )
    except (OSError, websockets.WebSocketException):
        await browser.close(code=1013, reason="the 3-D view is not ready")
        return
    async with upstream:
        await browser.accept(subprotocol=chosen)
        directions = [
            asyncio.create_task(_upwards(browser, upstream)),
            asyncio.create_task(_downwards(browser, upstream)),
        ]
        try:
            await asyncio.wait(directions, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for direction in directions:
                direction.cancel()
            await asyncio.gather(*directions, return_exceptions=True)
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):
        await browser.close()


async def _upwards(browser: WebSocket, upstream: ClientConnection) -> None:
    while True:
        message = await browser.receive()
        if message["type"] == "websocket.disconnect":
            return
        data = message.get("bytes") or message.get("text") or b""
        if isinstance(data, bytes) and any(name in data for name in _REFUSED):
            continue
        await upstream.send(data)


async def _downwards(browser: WebSocket, upstream: ClientConnection) -> None:
    async for data in upstream:
        if isinstance(data, bytes):
            await browser.send_bytes(data)
        else:
            await browser.send_text(data)
