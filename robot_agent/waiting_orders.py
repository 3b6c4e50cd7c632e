"""Orders that come in on the bus's threads and are carried out by the one that owns the work."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import TimeoutError as NoAnswerError

from weaver_shared.messages import Answer, Command

ANSWER_WITHIN = 2.5
"""s; opening a file and an ear on the bus takes a part of one."""


class WaitingOrders:
    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._woken = threading.Event()
        self._orders: list[tuple[Command, Future[Answer]]] = []

    def ask(self, command: Command) -> Answer:
        """Wait until the order was carried out; called on the bus's threads."""
        answer: Future[Answer] = Future()
        with self._lock:
            self._orders.append((command, answer))
            self._woken.set()
        try:
            return answer.result(ANSWER_WITHIN)
        except NoAnswerError:
            return Answer(accepted=False, reason=f"nobody got to it within {ANSWER_WITHIN:g} s")

    def carry_out(self, carry_out: Callable[[Command], Answer]) -> None:
        """All that have come in, one after the other."""
        with self._lock:
            orders, self._orders = self._orders, []
            self._woken.clear()
        for command, answer in orders:
            answer.set_result(carry_out(command))

    def wait(self, seconds: float) -> None:
        """Return when an order has come in, or after so many s."""
        self._woken.wait(seconds)
