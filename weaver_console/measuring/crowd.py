"""Other people's pages with their 3-D views beside the one that is measured, in a thread of their own."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from types import TracebackType

from weaver_console.measuring.narrow_way import NarrowWay
from weaver_console.measuring.page_client import PageClient
from weaver_console.measuring.scene_watcher import SceneWatcher
from weaver_shared.errors import ResourceError

FIRST = 100
"""Number of the first page, so that none has the name of one that is measured."""


class Crowd:
    def __init__(self, pages: int, port: int, robot: str, *, narrow_rate: float) -> None:
        """The first of them sits behind a way of `narrow_rate` bytes a second."""
        self._pages = [PageClient(FIRST + number, robot=robot) for number in range(pages)]
        self._port = port
        self._narrow_rate = narrow_rate
        self._there = threading.Event()
        self._over = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._stay()), name="crowd", daemon=True)

    def __enter__(self) -> Crowd:
        """Raises ResourceError when they do not all see the robot within 30 s."""
        self._thread.start()
        if not self._there.wait(30.0):
            self._over.set()
            raise ResourceError("the other pages see no robot")
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._over.set()
        self._thread.join()

    async def _stay(self) -> None:
        narrow = NarrowWay(self._port, rate=self._narrow_rate)
        ports = [await narrow.open(), *[self._port] * len(self._pages)]
        tasks = [asyncio.create_task(self._visit(page, port)) for page, port in zip(self._pages, ports, strict=False)]
        while not self._over.is_set():
            if all(page.heard.states for page in self._pages):
                self._there.set()
            await asyncio.sleep(0.05)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await narrow.close()

    async def _visit(self, page: PageClient, port: int) -> None:
        reading = asyncio.create_task(page.run(port))
        try:
            while page.scene is None:
                await asyncio.sleep(0.05)
            await SceneWatcher().run(port, page.scene)
            await reading
        finally:
            reading.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await reading
