"""Close looks at the ground: asked for on the bus's threads, answered when the vision loop has taken the next one."""

from __future__ import annotations

import threading
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NoAnswerError

from robot_agent.perception import CloseLook
from weaver_shared.messages import Answer, Command, CommandName

PATIENCE = 2.5
"""s of the wall clock that a question waits for a picture; then it is refused, and nobody looks any more."""

REST_NS = 500_000_000
"""Between looks: each costs the vision loop about one picture, and odometry has to live on the others."""


class CloseLooks:
    """All who wait are answered by the same look."""

    def __init__(self, patience: float = PATIENCE) -> None:
        self._patience = patience
        self._lock = threading.Lock()
        self._waiting: list[Future[Answer]] = []
        self._looked_ns: int | None = None
        self._looking = False

    def ask(self, command: Command) -> Answer:
        """Wait for a look; called on the bus's threads."""
        if command.command is not CommandName.LOOK_CLOSELY:
            return Answer(accepted=False, reason=f"the vision loop does not know {command.command.value}")
        answer: Future[Answer] = Future()
        with self._lock:
            self._waiting.append(answer)
        try:
            return answer.result(self._patience)
        except NoAnswerError:
            with self._lock:
                if answer.done():
                    return answer.result()
                self._waiting.remove(answer)
                if self._looking:
                    return Answer(
                        accepted=True, reason="the look is still at work; an event will tell what it measured"
                    )
            reason = f"no picture was processed within {self._patience:g} s; the cameras or the odometry are silent"
            return Answer(accepted=False, reason=reason)

    @property
    def waiting(self) -> int:
        """Questions that have no answer yet."""
        with self._lock:
            return len(self._waiting)

    def due(self, stamp_ns: int) -> bool:
        """Whether the picture of this stamp is to be looked at closely; from then on a look is at work."""
        with self._lock:
            rested = self._looked_ns is None or abs(stamp_ns - self._looked_ns) >= REST_NS
            self._looking = rested and bool(self._waiting)
            return self._looking

    def answer(self, look: CloseLook) -> None:
        """Tell all who wait how many cells were measured, or why none."""
        with self._lock:
            self._looked_ns = look.stamp_ns
            self._looking = False
            waiting, self._waiting = self._waiting, []
            for answer in waiting:
                answer.set_result(Answer(accepted=look.cells > 0, reason=look.reason, applied_value=float(look.cells)))
