"""One operator's side of the command protocol: sequence numbers, the lease's epoch, and keeping the lease alive."""

from __future__ import annotations

import threading

from weaver_shared.bus import Bus
from weaver_shared.errors import ResourceError
from weaver_shared.messages import Answer, Command, CommandName, Waypoint

RETAIN_PERIOD = 0.25


class Operator:
    """Sends commands to one robot. Safe to use from several threads."""

    def __init__(self, bus: Bus, robot_id: str, name: str) -> None:
        self._bus = bus
        self._robot_id = robot_id
        self._name = name
        self._lock = threading.Lock()
        self._sequence = 0
        self._epoch = 0
        self._ended = threading.Event()
        self._retainer: threading.Thread | None = None

    @property
    def has_held_control(self) -> bool:
        return self._epoch > 0

    def send(
        self,
        command: CommandName,
        *,
        name: str = "",
        value: float = 0.0,
        seconds: float = 0.0,
        reason: str = "",
        waypoints: tuple[Waypoint, ...] = (),
    ) -> Answer:
        """Ask and wait for the answer. Raises ResourceError when the robot does not answer."""
        with self._lock:
            self._sequence += 1
            answer = self._bus.request(
                self._robot_id,
                Command(
                    command=command,
                    operator=self._name,
                    lease_epoch=self._epoch,
                    sequence=self._sequence,
                    name=name,
                    value=value,
                    seconds=seconds,
                    reason=reason,
                    waypoints=waypoints,
                ),
            )
            if command is CommandName.TAKE_CONTROL and answer.accepted:
                self._epoch = answer.lease_epoch
            return answer

    def retain_in_background(self) -> None:
        """Keep the lease alive from a thread of its own until `close()`."""
        self._retainer = threading.Thread(target=self._retain, daemon=True)
        self._retainer.start()

    def close(self) -> None:
        """End the keeping. Returns when nothing more is sent, so the bus may then be closed."""
        self._ended.set()
        if self._retainer is not None:
            self._retainer.join()

    def _retain(self) -> None:
        while not self._ended.wait(RETAIN_PERIOD):
            try:
                self.send(CommandName.RETAIN_CONTROL)
            except ResourceError:
                continue
