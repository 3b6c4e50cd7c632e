"""A way between two processes that can fall silent: nothing arrives any more, and no end is told that it is so."""

from __future__ import annotations

import asyncio
import contextlib

from weaver_console.measuring.loopback_way import LoopbackWay, until_one_ends


class SilentWay(LoopbackWay):
    """Passes on both ways at once, while it is open."""

    CHUNK = 65536

    def __init__(self, port: int) -> None:
        super().__init__(port)
        self._passable = asyncio.Event()
        self._passable.set()

    def cut(self) -> None:
        self._passable.clear()

    def restore(self) -> None:
        """What was under way when it was cut is lost with its connections, as after a long outage."""
        self.drop()
        self._passable.set()

    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        await self._passable.wait()
        above, below = await asyncio.open_connection("127.0.0.1", self._port, limit=self.CHUNK)
        both = [asyncio.create_task(self._pass_on(*ends)) for ends in ((reader, below), (above, writer))]
        try:
            await until_one_ends(*both)
        finally:
            below.close()

    async def _pass_on(self, source: asyncio.StreamReader, to: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError):
            while data := await source.read(self.CHUNK):
                await self._passable.wait()
                to.write(data)
                await to.drain()
