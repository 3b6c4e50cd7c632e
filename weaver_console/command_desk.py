"""Carries operators' commands to robots: numbers them, adds the lease epoch, waits for the answer elsewhere."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from weaver_console.link import Link
from weaver_console.page_messages import CommandRequest, Teleoperation
from weaver_shared.errors import WeaverError
from weaver_shared.messages import Answer, Command, CommandName, Severity, TeleopFrame, Waypoint

ANSWER_TIMEOUT = 1.0
"""Seconds to wait for a robot's answer."""

_WITH_VALUE = (
    CommandName.SET_OVERRIDE,
    CommandName.LOOK_CLOSELY,
    CommandName.SKIP_WAYPOINT,
    CommandName.RETURN_TO_START,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Reply:
    robot: str
    command: CommandName
    answer: Answer
    round_trip: float  # s

    def to_page(self, request_id: str | None) -> dict[str, object]:
        answer = self.answer
        return {
            "type": "answer",
            "id": request_id,
            "robot": self.robot,
            "command": self.command.value,
            "accepted": answer.accepted,
            "reason": answer.reason,
            "applied_value": answer.applied_value if self.command in _WITH_VALUE else None,
            "lease_epoch": answer.lease_epoch,
            "round_trip_s": round(self.round_trip, 5),
        }


class CommandDesk:
    """One a console. Sequence numbers begin at the wall clock: a restarted console is not taken for a replay."""

    def __init__(self, link: Link, *, wall_time_ns: Callable[[], int] = time.time_ns) -> None:
        self._link = link
        self._wall_time_ns = wall_time_ns
        self._sequence = 0
        self._lock = threading.Lock()
        self._epochs: dict[tuple[str, str], int] = {}
        self._workers = ThreadPoolExecutor(max_workers=16, thread_name_prefix="command")
        # NOTE: stops have threads of their own, so that no number of commands to silent robots can delay one.
        self._stoppers = ThreadPoolExecutor(max_workers=4, thread_name_prefix="stop")

    def close(self) -> None:
        self._workers.shutdown(wait=False, cancel_futures=True)
        self._stoppers.shutdown(wait=False, cancel_futures=True)

    async def send(self, operator: str, robot: str, request: CommandRequest) -> Reply:
        """Ask the robot; a robot that does not answer counts as a refusal that says so."""
        command = Command(
            command=request.command,
            operator=operator,
            lease_epoch=self._epoch(operator, robot),
            sequence=self._next_sequence(),
            name=request.name,
            value=request.value,
            seconds=request.seconds,
            reason=request.reason,
            waypoints=tuple(Waypoint(x=place.x, y=place.y) for place in request.waypoints),
        )
        workers = self._stoppers if request.command is CommandName.STOP else self._workers
        started = time.perf_counter()
        answer = await asyncio.get_running_loop().run_in_executor(workers, self._ask, robot, command)
        if answer.accepted and request.command is CommandName.TAKE_CONTROL:
            self._epochs[operator, robot] = answer.lease_epoch
        return Reply(robot=robot, command=request.command, answer=answer, round_trip=time.perf_counter() - started)

    def teleoperate(self, operator: str, robot: str, stick: Teleoperation) -> None:
        frame = TeleopFrame(
            operator=operator,
            lease_epoch=self._epoch(operator, robot),
            sequence=self._next_sequence(),
            dead_man=stick.dead_man,
            forward=stick.forward,
            left=stick.left,
            turn=stick.turn,
        )
        self._link.teleoperate(robot, frame)

    def _ask(self, robot: str, command: Command) -> Answer:
        try:
            return self._link.request(robot, command, ANSWER_TIMEOUT)
        except WeaverError as error:
            text = f"{command.command.value.replace('_', ' ')} did not reach {robot}: {error}"
            if command.command is not CommandName.RETAIN_CONTROL:
                self._link.events.add(robot, Severity.ERROR, command.operator, text)
            return Answer(accepted=False, reason=str(error))

    def _epoch(self, operator: str, robot: str) -> int:
        """Epoch of the operator's lease: from the answer that granted it, or as the robot publishes it."""
        granted = self._epochs.get((operator, robot), 0)
        record = self._link.robot(robot)
        lease = record.lease if record is not None else None
        if lease is not None and lease.holder == operator:
            return max(granted, lease.epoch)
        return granted

    def _next_sequence(self) -> int:
        with self._lock:
            self._sequence = max(self._sequence + 1, self._wall_time_ns() // 1000)
            return self._sequence
