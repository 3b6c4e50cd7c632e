"""The bus between processes: Zenoh peers, or memory within one process, with the same face."""

from __future__ import annotations

import json
import logging
import socket
import threading
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol, TypeVar

import zenoh

from weaver_shared import codec
from weaver_shared.bus_drain import Drain, Haste
from weaver_shared.bus_security import own_settings
from weaver_shared.errors import MessageError, ResourceError
from weaver_shared.messages import Answer, Command
from weaver_shared.topics import COMMANDS, ROOT, Policy, Priority, Query, Topic, robot_key

logger = logging.getLogger(__name__)

Q = TypeVar("Q")
A = TypeVar("A")

Receiver = Callable[[str, str, Any], None]
"""Called with robot id, key under the robot and the message; must return at once (put it into a LatestSlot)."""

FaultReceiver = Callable[[str, str], None]
"""Called with robot id and what is wrong with something that it said."""

Watcher = Callable[[str, str, bool], None]
"""Called with robot id, process name and whether it has come or gone."""


class Bus(Protocol):
    def publish(self, robot_id: str, topic: Topic, message: Any, **parts: object) -> None:
        """Send without ever blocking on a slow receiver."""
        ...

    def subscribe(self, robot_id: str, topic: Topic, receiver: Receiver) -> None:
        """Receive a topic of one robot, or of all with `*`; reliable topics begin with their last values."""
        ...

    def serve(self, robot_id: str, answer: Callable[[Command], Answer]) -> None:
        """Answer the commands sent to this robot."""
        ...

    def request(self, robot_id: str, command: Command, timeout: float = 1.0) -> Answer:
        """Send a command and wait for the answer. Raises ResourceError when the robot does not answer."""
        ...

    def answer_queries(self, robot_id: str, query: Query[Q, A], answer: Callable[[Q], A]) -> None:
        """Answer the questions of one kind that are sent to this robot."""
        ...

    def ask(self, robot_id: str, query: Query[Q, A], question: Q, timeout: float = 1.0) -> A:
        """Send a question and wait for the answer. Raises ResourceError when nobody answers."""
        ...

    def announce(self, robot_id: str, process: str) -> None:
        """Say that a process of this robot is alive for as long as the bus is open."""
        ...

    def watch(self, watcher: Watcher) -> None:
        """Hear of processes coming and going."""
        ...

    def hear_faults(self, receiver: FaultReceiver) -> None:
        """Hear of messages to us that could not be read."""
        ...

    def close(self) -> None: ...


class MemoryBus:
    """Delivers within the process, at once and in order: the bus of lock-step runs and of most tests."""

    def __init__(self) -> None:
        self._receivers: list[tuple[str, Topic, Receiver]] = []
        self._last: dict[tuple[str, str], tuple[Topic, Any]] = {}
        self._servers: dict[tuple[str, str], Callable[[Any], Any]] = {}
        self._alive: list[tuple[str, str]] = []
        self._watchers: list[Watcher] = []

    def publish(self, robot_id: str, topic: Topic, message: Any, **parts: object) -> None:
        key = topic.at(**parts)
        if topic.policy is Policy.RELIABLE:
            self._last[robot_id, key] = (topic, message)
        for wanted, subscribed, receiver in self._receivers:
            if subscribed is topic and wanted in ("*", robot_id):
                receiver(robot_id, key, message)

    def subscribe(self, robot_id: str, topic: Topic, receiver: Receiver) -> None:
        self._receivers.append((robot_id, topic, receiver))
        for (owner, key), (published, message) in list(self._last.items()):
            if published is topic and robot_id in ("*", owner):
                receiver(owner, key, message)

    def serve(self, robot_id: str, answer: Callable[[Command], Answer]) -> None:
        self.answer_queries(robot_id, COMMANDS, answer)

    def request(self, robot_id: str, command: Command, timeout: float = 1.0) -> Answer:
        return self.ask(robot_id, COMMANDS, command, timeout)

    def answer_queries(self, robot_id: str, query: Query[Q, A], answer: Callable[[Q], A]) -> None:
        self._servers[robot_id, query.key] = answer

    def ask(self, robot_id: str, query: Query[Q, A], question: Q, timeout: float = 1.0) -> A:
        if (robot_id, query.key) not in self._servers:
            raise ResourceError(f"no robot {robot_id!r} on the bus")
        reply: A = self._servers[robot_id, query.key](question)
        return reply

    def announce(self, robot_id: str, process: str) -> None:
        self._alive.append((robot_id, process))
        for watcher in self._watchers:
            watcher(robot_id, process, True)

    def watch(self, watcher: Watcher) -> None:
        self._watchers.append(watcher)
        for robot_id, process in self._alive:
            watcher(robot_id, process, True)

    def hear_faults(self, receiver: FaultReceiver) -> None:
        """Nothing travels as bytes here, so nothing is unreadable."""

    def close(self) -> None:
        for robot_id, process in self._alive:
            for watcher in self._watchers:
                watcher(robot_id, process, False)
        self._alive.clear()


AWAITED_RATE = 50.0
"""Hz from which on a topic has a thread of its own where only the newest is heard."""

_PRIORITIES = {
    Priority.REAL_TIME: zenoh.Priority.REAL_TIME,
    Priority.INTERACTIVE: zenoh.Priority.INTERACTIVE_HIGH,
    Priority.DATA: zenoh.Priority.DATA,
    Priority.BACKGROUND: zenoh.Priority.DATA_LOW,
}


def _haste(topic: Topic) -> Haste:
    """What comes as often as the drain looks is cheaper waited for than looked for; and pages live by it."""
    if topic.priority not in (Priority.REAL_TIME, Priority.INTERACTIVE):
        return Haste.PATIENT
    return Haste.AWAITED if topic.rate >= AWAITED_RATE else Haste.SOON


class ZenohBus:
    """A Zenoh peer on loopback TCP; large messages go through shared memory by Zenoh's own default.

    `listen` and `connect` are Zenoh endpoints such as `tcp/127.0.0.1:7447`. Peers found through one connection
    connect to each other, so the death of any process leaves the rest in touch.
    """

    def __init__(
        self,
        *,
        listen: Iterable[str] = ("tcp/127.0.0.1:0",),
        connect: Iterable[str] = (),
        settings: Mapping[str, object] | None = None,
        newest_only: bool = False,
    ) -> None:
        """`settings` of Zenoh replace the usual ones; if None, those of a guarded bus that the environment names.
        With `newest_only`, messages that a newer one of their key has overtaken are left out, unless each counts.

        Raises ResourceError when the endpoints can not be listened on.
        """
        config = zenoh.Config()
        usual: dict[str, object] = {
            "mode": "peer",
            "listen/endpoints": list(listen),
            "connect/endpoints": list(connect),
            "connect/timeout_ms": -1,  # go on trying: 0 gives up for good when the other end starts later
            "connect/exit_on_failure": False,
            "connect/retry": {"period_init_ms": 200, "period_max_ms": 1000, "period_increase_factor": 1.5},
            "scouting/multicast/enabled": False,
            "scouting/gossip/enabled": True,
            "transport/link/tx/lease": 2000,
        }
        asked = own_settings() if settings is None else settings
        for key, value in {**usual, **asked}.items():
            config.insert_json5(key, json.dumps(value))
        try:
            self._session = zenoh.open(config)
        except zenoh.ZError as error:
            if asked.get("mode") == "client":
                who, where = asked["transport/auth/usrpwd/user"], ", ".join(connect)
                raise ResourceError(f"the router at {where} is not there or does not let {who} in: {error}") from error
            raise ResourceError(f"the bus can not listen on {', '.join(listen)}: {error}") from error
        self._drain = Drain(self._keeping, closed=zenoh.ZError) if newest_only else None
        self._publishers: dict[str, zenoh.Publisher] = {}
        self._last: dict[str, bytes] = {}
        self._lock = threading.Lock()
        self._kept: list[Any] = []
        self._queryable_of: set[str] = set()
        self._reliable: list[tuple[str, Topic, Receiver]] = []
        self._fault_receivers: list[FaultReceiver] = []
        self._closed = False

    def publish(self, robot_id: str, topic: Topic, message: Any, **parts: object) -> None:
        key = robot_key(robot_id, topic.at(**parts))
        data = codec.encode(message)
        with self._lock:
            if self._closed:
                return
            if topic.policy is Policy.RELIABLE:
                self._last[key] = data
                self._serve_last_values(robot_id)
            publisher = self._publishers.get(key)
            if publisher is None:
                publisher = self._session.declare_publisher(
                    key,
                    priority=_PRIORITIES[topic.priority],
                    congestion_control=zenoh.CongestionControl.DROP,
                    express=topic.priority is Priority.REAL_TIME,
                )
                self._publishers[key] = publisher
        publisher.put(data)

    def subscribe(self, robot_id: str, topic: Topic, receiver: Receiver) -> None:
        pattern = f"{ROOT}/{robot_id}/{topic.pattern}"

        if self._drain is not None:
            self._drain.declare(
                pattern,
                lambda key, data: self._deliver(key, data, topic, receiver),
                each_counts=topic.policy is Policy.LOGGED,
                haste=_haste(topic),
            )
        else:
            self._kept.append(
                self._session.declare_subscriber(
                    pattern,
                    lambda sample: self._deliver(str(sample.key_expr), sample.payload.to_bytes(), topic, receiver),
                )
            )
        if topic.policy is Policy.RELIABLE:
            self._reliable.append((pattern, topic, receiver))
            self._fetch(pattern, topic, receiver)

    def serve(self, robot_id: str, answer: Callable[[Command], Answer]) -> None:
        self.answer_queries(robot_id, COMMANDS, answer)

    def request(self, robot_id: str, command: Command, timeout: float = 1.0) -> Answer:
        return self.ask(robot_id, COMMANDS, command, timeout)

    def answer_queries(self, robot_id: str, query: Query[Q, A], answer: Callable[[Q], A]) -> None:
        key = robot_key(robot_id, query.key)

        def handle(asked: zenoh.Query) -> None:
            with asked:
                try:
                    question = codec.decode(asked.payload.to_bytes() if asked.payload else b"", query.question)
                    reply = answer(question)
                except MessageError as error:
                    reply = query.refuse(f"the {query.question.__name__.lower()} could not be read: {error}")
                asked.reply(key, codec.encode(reply))

        self._kept.append(self._session.declare_queryable(key, handle))

    def ask(self, robot_id: str, query: Query[Q, A], question: Q, timeout: float = 1.0) -> A:
        replies = self._session.get(
            robot_key(robot_id, query.key),
            payload=codec.encode(question),
            timeout=timeout,
            priority=_PRIORITIES[query.priority],
            express=query.priority is Priority.REAL_TIME,
        )
        for reply in replies:
            if reply.ok is not None:
                return codec.decode(reply.ok.payload.to_bytes(), query.answer)
        raise ResourceError(f"robot {robot_id!r} does not answer")

    def announce(self, robot_id: str, process: str) -> None:
        key = robot_key(robot_id, f"alive/{process}")
        self._kept.append(self._session.liveliness().declare_token(key))

    def watch(self, watcher: Watcher) -> None:
        def changed(sample: zenoh.Sample) -> None:
            _, robot_id, _, process = str(sample.key_expr).split("/", 3)
            came = sample.kind == zenoh.SampleKind.PUT
            if came:
                # Late values of a robot that appears after we subscribed; asked outside Zenoh's own thread.
                threading.Thread(target=self._refetch, args=(robot_id,), daemon=True).start()
            watcher(robot_id, process, came)

        subscriber = self._session.liveliness().declare_subscriber(f"{ROOT}/*/alive/**", changed, history=True)
        self._kept.append(subscriber)

    def hear_faults(self, receiver: FaultReceiver) -> None:
        self._fault_receivers.append(receiver)

    def alive(self, robot_id: str, timeout: float = 0.5) -> tuple[str, ...]:
        """Processes of a robot that are on the bus now."""
        replies = self._session.liveliness().get(robot_key(robot_id, "alive/**"), timeout=timeout)
        return tuple(str(r.ok.key_expr).split("/", 3)[3] for r in replies if r.ok is not None)

    def close(self) -> None:
        with self._lock:
            self._closed = True
        if self._drain is not None:
            self._drain.end()
        self._session.close()  # type: ignore[no-untyped-call]
        if self._drain is not None:
            self._drain.wait()

    def _keeping(self, pattern: str, room: int) -> Any:
        channel: Any = zenoh.handlers.RingChannel(room)
        return self._session.declare_subscriber(pattern, channel)

    def _serve_last_values(self, robot_id: str) -> None:
        if robot_id in self._queryable_of:
            return
        self._queryable_of.add(robot_id)

        def handle(query: zenoh.Query) -> None:
            with query:
                wanted = query.key_expr
                with self._lock:
                    values = list(self._last.items())
                for key, data in values:
                    if wanted.intersects(zenoh.KeyExpr(key)):
                        query.reply(key, data)

        for folder in ("state", "tele"):
            self._kept.append(self._session.declare_queryable(robot_key(robot_id, f"{folder}/**"), handle))

    def _refetch(self, robot_id: str) -> None:
        for pattern, topic, receiver in list(self._reliable):
            if pattern.split("/", 2)[1] in ("*", robot_id) and not self._closed:
                self._fetch(f"{ROOT}/{robot_id}/{topic.pattern}", topic, receiver)

    def _fetch(self, pattern: str, topic: Topic, receiver: Receiver) -> None:
        def receive(reply: zenoh.Reply) -> None:
            if reply.ok is not None:
                self._deliver(str(reply.ok.key_expr), reply.ok.payload.to_bytes(), topic, receiver)

        try:
            self._session.get(
                pattern, receive, timeout=2.0, consolidation=zenoh.ConsolidationMode.NONE, target=zenoh.QueryTarget.ALL
            )
        except zenoh.ZError:
            if not self._closed:
                raise

    def _deliver(self, key: str, data: bytes, topic: Topic, receiver: Receiver) -> None:
        _, robot_id, rest = key.split("/", 2)
        try:
            message = codec.decode(data, topic.message)
        except MessageError as error:
            if not self._fault_receivers:
                logger.warning("dropped a message on %s: %s", key, error)
            for fault_receiver in self._fault_receivers:
                fault_receiver(robot_id, str(error))
            return
        receiver(robot_id, rest, message)


def free_port() -> int:
    """A TCP port on loopback that was free a moment ago."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


__all__ = ["Bus", "MemoryBus", "Receiver", "Watcher", "ZenohBus", "free_port"]
