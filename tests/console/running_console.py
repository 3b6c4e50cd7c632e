"""A console's parts on a bus within the process, with one robot and a clock that only tests move."""

from __future__ import annotations

import json
import shutil
import socket
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
from websockets.sync.client import ClientConnection, connect
from wire_robot import WireRobot

from weaver_console.access import Access, Role, UserStore
from weaver_console.app import create_app
from weaver_console.database import Database
from weaver_console.hub import Hub
from weaver_console.link import Link
from weaver_console.web_server import web_server
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import CommandName


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    bus: MemoryBus
    clock: SimulatedClock
    link: Link

    def robot(self, robot_id: str = "weaver", **settings: str) -> WireRobot:
        return WireRobot(self.bus, robot_id, **settings)

    def forward(self, robot: WireRobot, seconds: float) -> None:
        """Let the robot publish at 50 Hz for a while, and the console look after it."""
        for _ in range(round(seconds * 50)):
            self.clock.forward(seconds=0.02)
            robot.step()
            self.link.check()


PASSWORD = "six legs good"


class Page:
    """A page's end of the WebSocket: says things, and waits for the kind of message it wants."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self._unread: list[dict[str, Any]] = []

    def say(self, **message: object) -> None:
        self.connection.send(json.dumps(message))

    def hear(self, kind: str, **fields: object) -> dict[str, Any]:
        """The next message of a kind and with these fields within 10 s; those before it are dropped."""
        deadline = time.monotonic() + 10.0
        while time.monotonic() < deadline:
            while self._unread:
                message = self._unread.pop(0)
                if message["type"] == kind and all(message.get(name) == value for name, value in fields.items()):
                    return message
            self._unread = json.loads(self.connection.recv(timeout=10.0))
        raise TimeoutError(f"no {kind} {fields} came")

    def command(self, what: CommandName, /, **fields: object) -> dict[str, Any]:
        self.say(type="command", id=what.value, command=what.value, **fields)
        return self.hear("answer", id=what.value)

    def select(self, robot: WireRobot) -> None:
        for _ in range(6):
            robot.step()
        self.say(type="select", robot=robot.robot_id)
        self.hear("selected", robot=robot.robot_id)


class Console:
    """A console served on loopback from a thread, on a bus within the process."""

    def __init__(
        self,
        bus: MemoryBus,
        folder: Path | None,
        *,
        users: dict[str, Role] | None = None,
        proxies: tuple[str, ...] = (),
    ) -> None:
        """Without `users` nobody needs to log in; their password is PASSWORD."""
        self.bus = bus
        self.database = Database(None)
        self.hub = Hub(Link(bus), database=self.database)
        self.users = UserStore(self.database)
        for name, role in (users or {}).items():
            self.users.add(name, role, PASSWORD)
        self.data = Path(tempfile.mkdtemp(prefix="console-"))
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        # Its clock stands still: however slow the computer, ten guesses are ten guesses within a minute.
        access = Access(host="127.0.0.1", database=self.database, guarded=users is not None, now=lambda: 1e9)
        self._server = web_server(create_app(self.hub, access, folder=folder, data=self.data), trusted_proxies=proxies)
        self._thread = threading.Thread(target=self._server.run, kwargs={"sockets": [self._listener]})
        self._thread.start()
        self.http = httpx.Client(base_url=f"http://127.0.0.1:{self.port}", trust_env=False)
        while not self._server.started:
            time.sleep(0.005)

    def log_in(self, name: str) -> dict[str, str]:
        """Headers by which this user is known from then on."""
        answer = self.http.post("/api/login", json={"name": name, "password": PASSWORD})
        self.http.cookies.clear()
        return {"Cookie": answer.headers["set-cookie"].split(";")[0]}

    def connect(self, path: str, **options: Any) -> ClientConnection:
        return connect(f"ws://127.0.0.1:{self.port}{path}", proxy=None, compression=None, **options)

    def page(self, page: str = "page-0001", operator: str = "anna", **options: Any) -> ClientConnection:
        return self.connect(f"/ws?page={page}&operator={operator}", **options)

    def close(self) -> None:
        self.http.close()
        self._server.should_exit = True
        self._thread.join()
        self._listener.close()
        shutil.rmtree(self.data)
