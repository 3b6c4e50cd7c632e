"""Control handed over by request and grant, between operators at this console.

An operator asks; who has control sees who asks and why, and hands over or declines. Silence is answered too: with what
the asker can do. The robot knows nothing of requests: what is granted is taken with that as the reason, at once, so
that the robot is never without an operator in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from weaver_console.link import Link
from weaver_shared.errors import InputError
from weaver_shared.messages import Severity

ANSWER_WITHIN = 15.0
"""s that the holder has to answer."""

LONGEST_REASON = 120


class Party(Protocol):
    """An operator's page."""

    operator: str

    @property
    def robot(self) -> str | None: ...

    def tell(self, message: dict[str, object]) -> None: ...

    def take_granted(self, robot: str, reason: str) -> None:
        """Take control of the robot, which its holder has handed over."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class _Request:
    asker: Party
    holder: Party
    robot: str
    since_ns: int


class Handover:
    """Runs in the event loop. Raises InputError on what can not be asked, with what to do instead."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._present: list[Party] = []
        self._requests: list[_Request] = []

    def enter(self, party: Party) -> None:
        self._present.append(party)

    def leave(self, party: Party) -> None:
        self._present = [one for one in self._present if one is not party]
        for request in [one for one in self._requests if party in (one.asker, one.holder)]:
            self._end(request, "lost", f"{party.operator} has left; look who has control now")

    def ask(self, asker: Party, reason: str) -> None:
        robot = asker.robot
        if robot is None:
            raise InputError("no robot is selected")
        name = self._holder(robot)
        if name == "":
            raise InputError("nobody has control; take control")
        if name == asker.operator:
            raise InputError("you have control already")
        holder = next((one for one in self._present if one.operator == name), None)
        if holder is None:
            raise InputError(f"{name} is not at this console and can not be asked; take control with a reason")
        if any(one.asker is asker and one.robot == robot for one in self._requests):
            raise InputError(f"{name} has been asked already")
        reason = " ".join(reason.split())[:LONGEST_REASON]
        self._requests.append(_Request(asker=asker, holder=holder, robot=robot, since_ns=self._link.clock.now_ns()))
        holder.tell({
            "type": "asked", "robot": robot, "asker": asker.operator, "reason": reason,
            "answer_within_s": ANSWER_WITHIN,
        })  # fmt: skip
        self._tell_asker(
            asker, robot, name, "waiting", f"{name} has been asked and has {ANSWER_WITHIN:.0f} s to answer"
        )
        self._log(robot, asker.operator, f"asks {name} for control" + (f": {reason}" if reason else ""))

    def answer(self, holder: Party, asker: str, grant: bool) -> None:
        request = next((one for one in self._requests if one.holder is holder and one.asker.operator == asker), None)
        if request is None:
            raise InputError(f"{asker!r:.60} asks for nothing any more")
        if self._holder(request.robot) != holder.operator:
            raise InputError("you have no control to hand over")
        verb = "hands control over to" if grant else "declines to hand control over to"
        self._log(request.robot, holder.operator, f"{verb} {asker}")
        if grant:
            request.asker.take_granted(request.robot, f"handed over by {holder.operator}")
            self._end(request, "granted", f"{holder.operator} has handed control over to you")
        else:
            self._end(
                request, "declined", f"{holder.operator} keeps control; ask again later, or take it with a reason"
            )

    def check(self) -> None:
        """Answer for holders who are silent or have lost control; called several times a second."""
        now_ns = self._link.clock.now_ns()
        for request in list(self._requests):
            name = request.holder.operator
            holder = self._holder(request.robot)
            if request.asker.robot != request.robot or holder == request.asker.operator:
                self._end(request, "over", "the request is over")
            elif holder != name:
                now = f"{holder} has control now" if holder else "nobody has control now; take control"
                self._end(request, "lost", f"{name} has lost control meanwhile: {now}")
            elif now_ns - request.since_ns > ANSWER_WITHIN * 1e9:
                self._log(request.robot, name, f"has not answered {request.asker.operator}")
                text = f"{name} has not answered for {ANSWER_WITHIN:.0f} s; ask again, or take control with a reason"
                self._end(request, "unanswered", text)

    def _end(self, request: _Request, state: str, text: str) -> None:
        self._requests.remove(request)
        self._tell_asker(request.asker, request.robot, request.holder.operator, state, text)
        request.holder.tell({"type": "asked_no_more", "robot": request.robot, "asker": request.asker.operator})

    def _tell_asker(self, asker: Party, robot: str, holder: str, state: str, text: str) -> None:
        asker.tell({"type": "request", "robot": robot, "holder": holder, "state": state, "text": text})

    def _holder(self, robot: str) -> str:
        record = self._link.robot(robot)
        lease = record.lease if record is not None else None
        return lease.holder if lease is not None else ""

    def _log(self, robot: str, who: str, text: str) -> None:
        self._link.events.add(robot, Severity.INFO, who, f"{who} {text}")
