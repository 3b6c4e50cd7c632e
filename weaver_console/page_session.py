"""One page at the console: what it asks is done here, what it must know is sent from here."""

from __future__ import annotations

import asyncio
import math
import time
from collections import deque
from collections.abc import Callable, Coroutine
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console import page_messages as p
from weaver_console.access import Identity
from weaver_console.access.rate_limit import RateLimit
from weaver_console.command_desk import CommandDesk, Reply
from weaver_console.feed import Feed
from weaver_console.handover import Handover
from weaver_console.link import ELSEWHERE, Link
from weaver_console.pace import Pace
from weaver_console.plain import to_json
from weaver_console.robot_record import RobotRecord
from weaver_console.roster import Roster
from weaver_console.scene.layers import LAYERS, Legend, legend
from weaver_console.scene.page_scene import PageScene
from weaver_shared.config.navigation import PathFollowerConfig
from weaver_shared.errors import InputError, MessageError
from weaver_shared.messages import CommandName, Waypoint

FOLLOWER = PathFollowerConfig()
TICK, THRIFTY_TICK = 0.05, 0.2
"""Most seconds between two batches, and the least where the browser draws without a graphics card."""

MOST_WAITING = 500
"""Messages beyond which a page that does not read loses the oldest answers."""

SENDING_TIMEOUT = 20.0

COMMAND_RATE, COMMAND_BURST = 30.0, 60.0
"""Commands a second that one page may send in the long run, and at once: more than a hand on a slider."""


class PageSession:
    """Runs in the event loop; `pick` and `show_legend` may be called from any thread."""

    def __init__(
        self,
        *,
        page: str,
        scene_key: str,
        operator: str,
        who: Identity,
        still: Callable[[], Identity | None],
        link: Link,
        roster: Roster,
        desk: CommandDesk,
        handover: Handover,
    ) -> None:
        self.page = page
        self.scene_key = scene_key  # tells this page's 3-D view, which its sandbox leaves without a cookie
        self.operator = operator
        self.over = False  # the login has expired, or the user is no more
        self._who = who
        self._still = still
        self._limit = RateLimit(rate=COMMAND_RATE, burst=COMMAND_BURST, now=time.monotonic)
        self.scene: PageScene | None = None
        self.wishes: dict[str, object] = {}  # for a scene that is opened later
        self._link = link
        self._desk = desk
        self._handover = handover
        self._feed = Feed(link, roster)
        self._pace = Pace()
        self._waiting: deque[bytes] = deque(maxlen=MOST_WAITING)
        self._wake = asyncio.Event()
        self._new = False
        self._loop = asyncio.get_running_loop()
        self._lane = asyncio.Lock()
        self._tasks: set[asyncio.Task[None]] = set()
        self._retaining = False
        self._refused = ""
        self._layer = LAYERS[0]

    @property
    def robot(self) -> str | None:
        return self._feed.robot

    @property
    def _thrifty(self) -> bool:
        return self.scene is not None and self.scene.thrifty

    def greet(self, *, with_scene: bool) -> None:
        hello: dict[str, object] = {
            "type": "hello",
            "page": self.page,
            "operator": self.operator,
            "user": self._who.name,
            "role": self._who.role,
            "version": version("weaver-hexapod"),
            "scene": f"/viser/{self.scene_key}/" if with_scene else None,
            "layers": list(LAYERS),
            "layer": self._layer,
            "passing_radius_m": FOLLOWER.acceptance_radius,
            "goal_radius_m": FOLLOWER.goal_radius,
            "schema": 1,
        }
        self.tell(hello)
        self._put(self._feed.past_events())
        self.show_legend(legend(self._layer))

    def wake(self) -> None:
        """The robot has said something that should be seen at once."""
        if not self._thrifty:
            self._new = True
            self._wake.set()

    def check_login(self) -> None:
        """End the page of somebody who may be here no more; take note of another role."""
        who = self._still()
        if who is None:
            self.over = True
            self._wake.set()
        elif who != self._who:
            self._who = who
            self.tell({"type": "role", "role": who.role})

    async def send(self, send_text: Callable[[str], Coroutine[Any, Any, None]]) -> None:
        """Send batches until cancelled, until the login ends, or until a batch is not taken for 20 s."""
        due = self._loop.time()
        while not self.over:
            await self._until(due)
            messages = [self._waiting.popleft() for _ in range(len(self._waiting))]
            bulk = 0
            if self._new or self._loop.time() >= due:
                self._new = False
                if self._pace.ready:
                    messages += self._feed.collect(self._pace.room)
                    bulk = self._feed.bulk
                due = self._loop.time() + (THRIFTY_TICK if self._thrifty else TICK)
            if messages:
                self._pace.sent(self._loop.time(), bulk)
                async with asyncio.timeout(SENDING_TIMEOUT):
                    await send_text((b"[" + b",".join(messages) + b"]").decode())

    async def _until(self, due: float) -> None:
        """Until there is something to send at once, or the next batch is due."""
        if self._waiting or self._new or self._loop.time() >= due:
            return
        self._wake.clear()
        timer = self._loop.call_at(due, self._wake.set)
        try:
            await self._wake.wait()
        finally:
            timer.cancel()

    def receive(self, data: str | bytes) -> None:
        """Act on one frame from the page; whatever is wrong with it is answered, never raised."""
        try:
            self._act(p.read_page_message(data))
        except (MessageError, InputError) as error:
            self.tell({"type": "error", "reason": str(error)})

    def end(self) -> None:
        for task in self._tasks:
            task.cancel()

    def tell(self, message: dict[str, object]) -> None:
        self._put(to_json(message))

    def pick(self, point: NDArray[np.float64] | None) -> None:
        """A click in this page's scene, from viser's thread."""
        message: dict[str, object] = {"type": "missed", "reason": "there is no known ground there"}
        if point is not None:
            x, y, z = (round(float(value), 4) for value in point)
            message = {"type": "picked", "x": x, "y": y, "z": z}
        self._loop.call_soon_threadsafe(self.tell, message)

    def drag(self, index: int, point: NDArray[np.float64], done: bool) -> None:
        """A waypoint in hand in this page's scene, from viser's thread."""
        x, y, z = (round(float(value), 4) for value in point)
        message: dict[str, object] = {"type": "dragged", "index": index, "x": x, "y": y, "z": z, "done": done}
        self._loop.call_soon_threadsafe(self.tell, message)

    def show_legend(self, scale: Legend) -> None:
        self._loop.call_soon_threadsafe(self.tell, scale.to_page())

    def _put(self, message: bytes) -> None:
        self._waiting.append(message)
        self._wake.set()

    def _act(self, message: p.PageMessage) -> None:
        match message:
            case p.Select():
                self._select(message.robot)
            case p.CommandRequest():
                self._command(message)
            case p.Retain():
                self._retain()
            case p.Teleoperation():
                self._teleoperate(message)
            case p.Draft():
                self._wish_draft(message)
            case p.ChooseLayer():
                self._choose_layer(message.name)
            case p.View() | p.Measure():
                self._wish_view(message)
            case p.Watch():
                self._feed.cameras, self._feed.features = message.cameras, message.features
            case p.AskForControl():
                self._require_operator()
                self._handover.ask(self, message.reason)
            case p.AnswerRequest():
                self._handover.answer(self, message.asker, message.grant)
            case p.Ping():
                self.tell({"type": "pong", "t": message.t})
            case p.Taken():
                self._pace.taken(self._loop.time(), message.frames)

    def _select(self, robot: str | None) -> None:
        if robot is not None and self._link.robot(robot) is None:
            known = ", ".join(record.robot_id for record in self._link.robots()) or "none yet"
            raise InputError(f"robot {robot!r:.60} is unknown; known are {known}")
        former = self._link.robot(self.robot) if self.robot is not None and self.robot != robot else None
        if former is not None and self._controls(former):
            if former.mode is not None and former.mode.mode == "WALK":
                raise InputError(f"{former.robot_id} is walking under your control; pause or stop it first")
            self._spawn(self._send(p.CommandRequest(id="", command=CommandName.RELEASE_CONTROL), former.robot_id, None))
        self._feed.select(robot)
        self._refused = ""
        self._wish(draft=(), selected=None)
        self.tell({"type": "selected", "robot": robot})

    def _controls(self, record: RobotRecord) -> bool:
        held = record.lease is not None and record.lease.holder == self.operator and not record.replays
        return held and record.heard(self._link.clock.now_ns())

    def _command(self, request: p.CommandRequest) -> None:
        robot = self.robot if request.robot is None else request.robot
        if refusal := self._who.refusal(request.command):
            self._refuse(request, robot or "", refusal)
        elif request.command is not CommandName.STOP and not self._limit.spend(""):
            self._refuse(request, robot or "", f"more than {COMMAND_RATE:.0f} commands a second; slow down")
        elif robot is None:
            self._refuse(request, "", "no robot is selected")
        elif robot != self.robot and request.command is not CommandName.STOP:
            self._refuse(request, robot, f"{robot!r:.60} is not the selected robot; only a stop may go to another one")
        elif self._link.robot(robot) is None:
            self._refuse(request, robot, f"robot {robot!r:.60} is unknown")
        else:
            self._spawn(self._send(request, robot, request.id))

    def _refuse(self, request: p.CommandRequest, robot: str, reason: str) -> None:
        self.tell({
            "type": "answer", "id": request.id, "robot": robot, "command": request.command.value, "accepted": False,
            "reason": reason, "applied_value": None, "lease_epoch": 0, "round_trip_s": 0.0,
        })  # fmt: skip

    async def _send(self, request: p.CommandRequest, robot: str, request_id: str | None) -> None:
        reply = await self._ask(request, robot)
        self.tell(reply.to_page(request_id))

    async def _ask(self, request: p.CommandRequest, robot: str) -> Reply:
        if request.command is CommandName.STOP or request.command in ELSEWHERE:
            return await self._desk.send(self.operator, robot, request)
        async with self._lane:  # one after the other, so that they arrive in the order of their numbers
            return await self._desk.send(self.operator, robot, request)

    def _retain(self) -> None:
        if self.robot is not None and not self._retaining and self._who.operates:
            self._retaining = True
            self._spawn(self._send_retain(self.robot))

    async def _send_retain(self, robot: str) -> None:
        try:
            reply = await self._ask(p.CommandRequest(id="", command=CommandName.RETAIN_CONTROL), robot)
        finally:
            self._retaining = False
        reason = "" if reply.answer.accepted else reply.answer.reason
        if reason and reason != self._refused:
            self.tell(reply.to_page(None))
        self._refused = reason

    def _teleoperate(self, stick: p.Teleoperation) -> None:
        if self.robot is None:
            raise InputError("no robot is selected")
        self._require_operator()
        if not all(math.isfinite(value) and abs(value) <= 1.0 for value in (stick.forward, stick.left, stick.turn)):
            raise InputError("forward, left and turn are shares of the robot's limits, from -1 to 1")
        self._desk.teleoperate(self.operator, self.robot, stick)

    def _require_operator(self) -> None:
        if refusal := self._who.refusal(CommandName.TAKE_CONTROL):
            raise InputError(refusal)

    def take_granted(self, robot: str, reason: str) -> None:
        """Take control of a robot whose holder has handed it over."""
        request = p.CommandRequest(id="", command=CommandName.TAKE_CONTROL, reason=reason)
        self._spawn(self._send(request, robot, None))

    def _wish_draft(self, draft: p.Draft) -> None:
        places, *areas = (
            tuple(Waypoint(x=place.x, y=place.y) for place in part) for part in (draft.waypoints, *draft.areas)
        )
        self._wish(draft=places, selected=draft.selected, areas=tuple(areas))

    def _wish_view(self, view: p.View | p.Measure) -> None:
        if isinstance(view, p.Measure):
            self._wish(measure=tuple(Waypoint(x=place.x, y=place.y) for place in view.places))
        else:
            told = {name: getattr(view, name) for name in view.__struct_fields__}
            self._wish(**{name: value for name, value in told.items() if value is not None})

    def _choose_layer(self, name: str) -> None:
        if name not in LAYERS:
            raise InputError(f"layer {name!r:.40} is unknown; known are {', '.join(LAYERS)}")
        self._layer = name
        self._wish(layer=name)
        record = self._link.robot(self.robot) if self.robot is not None else None
        self.show_legend(legend(name, record.ground.range() if record is not None else None))

    def _wish(self, **changes: object) -> None:
        self.wishes = {**self.wishes, **changes}
        if self.scene is not None:
            self.scene.wish(**changes)

    def _spawn(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.ensure_future(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
