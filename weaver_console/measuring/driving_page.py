"""A page whose operator has control and drives: by hand, with a stick held forward, or by cruise."""

from __future__ import annotations

import asyncio
import contextlib
import json
from typing import Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from weaver_shared.errors import ResourceError

RETAIN_PERIOD, STICK_PERIOD = 0.25, 0.05
PATIENCE = 20.0
CRUISE = 0.2  # m/s
DRIVES = ("cruise", "hand")


class DrivingPage:
    def __init__(self, port: int, robot: str) -> None:
        self._port = port
        self._robot = robot
        self._socket: ClientConnection | None = None
        self._jobs: list[asyncio.Task[None]] = []
        self._answers: dict[str, dict[str, Any]] = {}
        self._asked = 0
        self._known = asyncio.Event()
        self.told: list[str] = []  # texts of events

    async def enter(self) -> None:
        """Connect, as the same page every time, and choose the robot. Raises ResourceError when it is not there."""
        address = f"ws://127.0.0.1:{self._port}/ws?page=link-bench-1&operator=ada"
        try:
            async with asyncio.timeout(PATIENCE):
                while self._socket is None:
                    with contextlib.suppress(OSError, TimeoutError, ConnectionClosed):
                        self._socket = await connect(address, compression=None, max_size=None, proxy=None)
                    await asyncio.sleep(0.1)
                self._jobs.append(asyncio.create_task(self._listen(self._socket)))
                await self._known.wait()
        except TimeoutError as error:
            raise ResourceError(f"the page did not find {self._robot} at the console") from error
        await self._say(type="select", robot=self._robot)

    async def command(self, name: str, /, **fields: Any) -> dict[str, Any]:
        self._asked += 1
        identity = f"b{self._asked}"
        await self._say(type="command", id=identity, command=name, **fields)
        async with asyncio.timeout(PATIENCE):
            while identity not in self._answers:
                await asyncio.sleep(0.01)
        return self._answers.pop(identity)

    async def insist(self, name: str, /, **fields: Any) -> None:
        """Ask until it is granted. Raises ResourceError with the last refusal."""
        for _ in range(round(PATIENCE / 0.2)):
            answer = await self.command(name, **fields)
            if answer["accepted"]:
                return
            await asyncio.sleep(0.2)
        raise ResourceError(f"{name.replace('_', ' ')} was refused: {answer['reason']}")

    async def drive(self, how: str, direction: float) -> None:
        """Keep control from now on and drive in one of DRIVES, forward or back."""
        self._jobs.append(asyncio.create_task(self._keep_saying(RETAIN_PERIOD, type="retain")))
        if how == "cruise":
            await self.insist("start_cruise", name="forward", value=direction * CRUISE, seconds=60.0)
        else:
            stick = {"forward": direction, "left": 0.0, "turn": 0.0, "dead_man": True}
            self._jobs.append(asyncio.create_task(self._keep_saying(STICK_PERIOD, type="teleop", **stick)))

    def freeze(self) -> None:
        """Say and hear nothing more; the connection stands."""
        for job in self._jobs:
            job.cancel()
        self._jobs = []

    async def leave(self) -> None:
        self.freeze()
        if self._socket is not None:
            transport = self._socket.transport
            with contextlib.suppress(ConnectionClosed, TimeoutError):
                async with asyncio.timeout(1.0):
                    await self._socket.close()
            transport.abort()

    async def _say(self, **message: Any) -> None:
        assert self._socket is not None
        with contextlib.suppress(ConnectionClosed):
            await self._socket.send(json.dumps(message))

    async def _keep_saying(self, period: float, **message: Any) -> None:
        while True:
            await self._say(**message)
            await asyncio.sleep(period)

    async def _listen(self, socket: ClientConnection) -> None:
        with contextlib.suppress(ConnectionClosed):
            async for frame in socket:
                for message in json.loads(frame):
                    self._take(message)

    def _take(self, message: dict[str, Any]) -> None:
        match message["type"]:
            case "robots" if any(one["id"] == self._robot and one["alive"] for one in message["robots"]):
                self._known.set()
            case "answer" if message["id"] is not None:
                self._answers[message["id"]] = message
            case "events":
                self.told += [event["text"] for event in message["events"]]
            case "event":
                self.told.append(message["text"])
