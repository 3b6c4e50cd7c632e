"""A page as the console sees it: receives, reports what it has taken every 100 ms, and now and then commands."""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
import time
from dataclasses import dataclass, field

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

TAKING = 0.1
"""s between two looks at what has come, as the page does."""

COMMAND_PERIOD = 0.2

_STAMP = re.compile(r'"key":"(tele/state|tele/map/tile/[^"]*)","kind":"\w+","stamp_ns":(\d+)')
_ANSWER = re.compile(r'"type":"answer","id":"(m\d+)"')


@dataclass(slots=True, kw_only=True)
class Heard:
    """What came in a stretch of time; delays in s from the robot's stamp to the page's hands."""

    bytes: int = 0
    frames: int = 0
    states: list[float] = field(default_factory=list)
    tiles: list[float] = field(default_factory=list)
    tile_bytes: int = 0
    round_trips: list[float] = field(default_factory=list)


class PageClient:
    def __init__(self, number: int, *, robot: str, commands: bool = False) -> None:
        self.heard = Heard()
        self.scene: str | None = None
        self._number = number
        self._robot = robot
        self._commands = commands
        self._asked: dict[str, float] = {}
        self._untaken = 0
        self._selected = False

    async def run(self, port: int, *, headers: dict[str, str] | None = None) -> None:
        """Until cancelled or until the console goes."""
        address = f"ws://127.0.0.1:{port}/ws?page=measured-{self._number:04d}&operator=page {self._number}"
        async with connect(
            address.replace(" ", "%20"), compression=None, max_size=None, proxy=None, additional_headers=headers or {}
        ) as connection:
            jobs = [asyncio.create_task(self._take(connection)), asyncio.create_task(self._ask(connection))]
            try:
                with contextlib.suppress(ConnectionClosed):
                    await self._receive(connection)
            finally:
                for job in jobs:
                    job.cancel()

    def begin(self) -> None:
        """Count from now on."""
        self.heard = Heard()

    async def _receive(self, connection: ClientConnection) -> None:
        async for frame in connection:
            now = time.monotonic_ns()
            text = frame if isinstance(frame, str) else frame.decode()
            self._untaken += 1
            self._note(text, now)
            if not self._selected and '"type":"robots"' in text and f'"id":"{self._robot}"' in text:
                self._selected = True
                await connection.send(json.dumps({"type": "select", "robot": self._robot}))

    def _note(self, text: str, now_ns: int) -> None:
        heard = self.heard
        heard.bytes += len(text)
        heard.frames += 1
        for found in _STAMP.finditer(text):
            delay = (now_ns - int(found[2])) * 1e-9
            if found[1] == "tele/state":
                heard.states.append(delay)
            else:
                heard.tiles.append(delay)
                heard.tile_bytes += text.index("}", found.end()) - found.start()
        for found in _ANSWER.finditer(text):
            if (asked := self._asked.pop(found[1], None)) is not None:
                heard.round_trips.append(time.perf_counter() - asked)
        if self.scene is None and '"type":"hello"' in text:
            self.scene = next(m for m in json.loads(text) if m["type"] == "hello")["scene"]

    async def _take(self, connection: ClientConnection) -> None:
        while True:
            await asyncio.sleep(TAKING)
            if self._untaken:
                await connection.send(f'{{"type":"taken","frames":{self._untaken}}}')
            self._untaken = 0

    async def _ask(self, connection: ClientConnection) -> None:
        number = 0
        while self._commands:
            await asyncio.sleep(COMMAND_PERIOD)
            number += 1
            self._asked[f"m{number}"] = time.perf_counter()
            await connection.send(
                json.dumps({"type": "command", "id": f"m{number}", "command": "set_gait", "name": "tripod"})
            )
