"""A way between two processes that can fall silent: nothing arrives any more, and no end is told that it is so."""

from __future__ import annotations

import asyncio
import contextlib

CHUNK = 65536


class SilentWay:
    """Listens on loopback and passes on to `port`, both ways at once, while it is open."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._server: asyncio.Server | None = None
        self._carrying: set[asyncio.Task[None]] = set()
        self._passable = asyncio.Event()
        self._passable.set()

    async def open(self, at: int) -> None:
        """Listen at this port."""
        self._server = await asyncio.start_server(self._carry, "127.0.0.1", at, limit=CHUNK)

    def cut(self) -> None:
        self._passable.clear()

    def restore(self) -> None:
        """What was under way when it was cut is lost with its connections, as after a long outage."""
        for task in self._carrying:
            task.cancel()
        self._passable.set()

    async def close(self) -> None:
        if self._server is not None:
            self._server.close()
        for task in self._carrying:
            task.cancel()
        await asyncio.gather(*self._carrying, return_exceptions=True)

    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        own = asyncio.current_task()
        assert own is not None
        self._carrying.add(own)
        own.add_done_callback(self._carrying.discard)
        with contextlib.suppress(asyncio.CancelledError, OSError):
            await self._passable.wait()
            above, below = await asyncio.open_connection("127.0.0.1", self._port, limit=CHUNK)
            both = [asyncio.create_task(self._pass_on(*ends)) for ends in ((reader, below), (above, writer))]
            try:
                await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
            finally:
                for task in both:
                    task.cancel()
                below.close()
        writer.close()

    async def _pass_on(self, source: asyncio.StreamReader, to: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError):
            while data := await source.read(CHUNK):
                await self._passable.wait()
                to.write(data)
                await to.drain()
