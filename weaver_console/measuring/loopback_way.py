"""A way over loopback to a process, with something about it that a real network has."""

from __future__ import annotations

import asyncio
import contextlib
from abc import ABC, abstractmethod


class LoopbackWay(ABC):
    """Listens on loopback; each connection is carried to `port` by a task of its own."""

    CHUNK: int
    """Bytes that are passed on at once."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._server: asyncio.Server | None = None
        self._carrying: set[asyncio.Task[None]] = set()

    async def open(self, at: int = 0) -> int:
        """Listen at this port, or any; returns which."""
        self._server = await asyncio.start_server(self._accept, "127.0.0.1", at, limit=self.CHUNK)
        port: int = self._server.sockets[0].getsockname()[1]
        return port

    async def close(self) -> None:
        if self._server is not None:
            self._server.close()
        self.drop()
        await asyncio.gather(*self._carrying, return_exceptions=True)

    def drop(self) -> None:
        """End all connections."""
        for task in self._carrying:
            task.cancel()

    @abstractmethod
    async def _carry(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Pass on both ways until one end has enough."""

    async def _accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        own = asyncio.current_task()
        assert own is not None
        self._carrying.add(own)
        own.add_done_callback(self._carrying.discard)
        # NOTE: ending quietly when cancelled, as asyncio reports the cancelled task of a connection as a fault.
        with contextlib.suppress(asyncio.CancelledError, OSError):
            await self._carry(reader, writer)
        writer.close()


async def until_one_ends(*ways: asyncio.Task[None]) -> None:
    """Both directions of a connection end together."""
    try:
        await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in ways:
            task.cancel()
