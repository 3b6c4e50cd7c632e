"""Who may command the robot: one operator holds the lease, others watch, anyone may stop."""

from __future__ import annotations

from math import inf

from weaver_shared.messages import Answer, Command

LEASE_SECONDS = 2.0


class Authority:
    """One lease with an epoch that rises at every change of holder. Times are wall-clock nanoseconds handed in."""

    def __init__(self) -> None:
        self.holder = ""
        self.epoch = 0
        self._heard_ns = 0
        self._sequence = -1

    def take(self, command: Command, now_ns: int) -> Answer:
        """Grant the lease if it is free, expired, already theirs, or taken over with a reason."""
        self._expire(now_ns)
        if self.holder not in ("", command.operator) and not command.reason.strip():
            return Answer(
                accepted=False,
                reason=f"{self.holder} is in control; give a reason to take over",
                lease_epoch=self.epoch,
            )
        if self.holder != command.operator:
            self.holder = command.operator
            self.epoch += 1
        self._heard_ns = now_ns
        self._sequence = command.sequence
        return Answer(accepted=True, reason="", lease_epoch=self.epoch)

    def refusal(self, command: Command, now_ns: int) -> str:
        """Why this command of the holder's may not be carried out; empty if it may. Counts as a sign of life."""
        self._expire(now_ns)
        if not self.holder:
            return "nobody is in control; take control first"
        if self.holder != command.operator:
            return f"{self.holder} is in control"
        if command.lease_epoch != self.epoch:
            return f"the command belongs to lease {command.lease_epoch}, the current one is {self.epoch}"
        if command.sequence <= self._sequence:
            return f"command {command.sequence} is not newer than {self._sequence}, the last one seen"
        self._sequence = command.sequence
        self._heard_ns = now_ns
        return ""

    def release(self) -> None:
        self.holder = ""

    def silence(self, now_ns: int) -> float:
        """Seconds since the holder was last heard; infinite when nobody is in control."""
        self._expire(now_ns)
        return (now_ns - self._heard_ns) * 1e-9 if self.holder else inf

    def seconds_left(self, now_ns: int) -> float:
        return max(0.0, LEASE_SECONDS - self.silence(now_ns)) if self.holder else 0.0

    def _expire(self, now_ns: int) -> None:
        if self.holder and now_ns - self._heard_ns > LEASE_SECONDS * 1e9:
            self.holder = ""
