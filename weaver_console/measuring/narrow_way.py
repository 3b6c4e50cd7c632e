"""A way to the console that carries only so many bytes a second, for a page behind a poor network."""

from __future__ import annotations

import asyncio
import contextlib
import socket

BUFFER = 8192
"""Bytes that the way itself holds: a network that is slow, not one that keeps seconds of traffic."""


class NarrowWay:
    """Listens on loopback, passes on to `port`: upwards at once, downwards at `rate` bytes/s."""

    def __init__(self, port: int, *, rate: float) -> None:
        self._port = port
        self._rate = rate
        self._server: asyncio.Server | None = None
        self._carrying: set[asyncio.Task[None]] = set()

    async def open(self) -> int:
        """The port to connect to."""
        self._server = await asyncio.start_server(self._carry, "127.0.0.1", 0, limit=BUFFER)
        port: int = self._server.sockets[0].getsockname()[1]
        return port

    async def close(self) -> None:
        if self._server is not None:
            self._server.close()
        for task in self._carrying:
            task.cancel()
        await asyncio.gather(*self._carrying, return_exceptions=True)

    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        own = asyncio.current_task()
        if own is not None:
            self._carrying.add(own)
            own.add_done_callback(self._carrying.discard)
        narrow = socket.socket()
        narrow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
        narrow.setblocking(False)
        await asyncio.get_running_loop().sock_connect(narrow, ("127.0.0.1", self._port))
        above, below = await asyncio.open_connection(sock=narrow, limit=BUFFER)
        up = asyncio.create_task(_pass_on(reader, below, None))
        down = asyncio.create_task(_pass_on(above, writer, self._rate))
        # NOTE: ending quietly when cancelled, as asyncio reports the cancelled task of a connection as a fault.
        with contextlib.suppress(asyncio.CancelledError):
            await asyncio.wait((up, down), return_when=asyncio.FIRST_COMPLETED)
        for task in (up, down):
            task.cancel()
        below.close()
        writer.close()


async def _pass_on(source: asyncio.StreamReader, to: asyncio.StreamWriter, rate: float | None) -> None:
    with contextlib.suppress(ConnectionError):
        while data := await source.read(BUFFER):
            to.write(data)
            await to.drain()
            if rate is not None:
                await asyncio.sleep(len(data) / rate)
