"""Whoever watches a page's 3-D view: says where it looks from, as viser's page does, and takes all that is drawn."""

from __future__ import annotations

import contextlib

import msgspec
import viser
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1.0, 0.0, 0.0, 0.0),
    "position": (-1.0, -1.0, 1.0),
    "fov": 1.3,
    "near": 0.01,
    "far": 1000.0,
    "image_height": 600,
    "image_width": 800,
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
}


class SceneWatcher:
    def __init__(self) -> None:
        self.bytes = 0

    async def run(self, port: int, scene: str) -> None:
        """`scene` is the address that the page was told."""
        protocol = Subprotocol(f"viser-v{viser.__version__}")
        async with connect(
            f"ws://127.0.0.1:{port}{scene}", subprotocols=[protocol], compression=None, max_size=None, proxy=None
        ) as connection:
            await connection.send(msgspec.msgpack.encode(CAMERA))
            with contextlib.suppress(ConnectionClosed):
                async for data in connection:
                    self.bytes += len(data)
