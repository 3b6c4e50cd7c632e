"""A way to the console that carries only so many bytes a second, for a page behind a poor network."""

from __future__ import annotations

import asyncio
import contextlib
import socket

from weaver_console.measuring.loopback_way import LoopbackWay, until_one_ends

BUFFER = 8192
"""Bytes that the way itself holds: a network that is slow, not one that keeps seconds of traffic."""


class NarrowWay(LoopbackWay):
    """Passes on upwards at once, downwards at `rate` bytes/s."""

    CHUNK = BUFFER

    def __init__(self, port: int, *, rate: float) -> None:
        super().__init__(port)
        self._rate = rate

    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        narrow = socket.socket()
        narrow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
        narrow.setblocking(False)
        await asyncio.get_running_loop().sock_connect(narrow, ("127.0.0.1", self._port))
        above, below = await asyncio.open_connection(sock=narrow, limit=BUFFER)
        up = asyncio.create_task(_pass_on(reader, below, None))
        down = asyncio.create_task(_pass_on(above, writer, self._rate))
        try:
            await until_one_ends(up, down)
        finally:
            below.close()


async def _pass_on(source: asyncio.StreamReader, to: asyncio.StreamWriter, rate: float | None) -> None:
    with contextlib.suppress(ConnectionError):
        while data := await source.read(BUFFER):
            to.write(data)
            await to.drain()
            if rate is not None:
                await asyncio.sleep(len(data) / rate)
