"""Where a guided calibration has its pictures and samples from: the robot as it is now, or a recording of it."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Protocol

from robot_agent.recording import Recording
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.latest import LatestSlot
from weaver_shared.messages import ImuBatch, StereoFrame

MOST_WAITING = 2000
"""Batches of samples between two pictures: 20 s of control ticks."""


class SessionSource(Protocol):
    name: str
    ended: bool  # there will be no more

    def take(self, feel: Callable[[ImuBatch], None], wait: float) -> StereoFrame | None:
        """The next pair, waiting at most so many s for one; `feel` has what was felt before it. Raises InputError."""
        ...

    def close(self) -> None: ...


class LiveSource:
    """The newest pair wins, samples are all kept; the bus is the source's own."""

    name = "cameras"
    ended = False

    def __init__(self, bus: Bus, robot_id: str, *, inertia: bool) -> None:
        self._bus = bus
        self._newest: LatestSlot[StereoFrame] = LatestSlot()
        self._felt: deque[ImuBatch] = deque(maxlen=MOST_WAITING)
        bus.subscribe(robot_id, topics.STEREO, lambda _id, _key, frame: self._newest.put(frame))
        if inertia:
            bus.subscribe(robot_id, topics.PROPRIOCEPTION, lambda _id, _key, sensed: self._felt.append(sensed.imu))

    def take(self, feel: Callable[[ImuBatch], None], wait: float) -> StereoFrame | None:
        frame = self._newest.take(wait)
        while self._felt:
            feel(self._felt.popleft())
        return frame

    def close(self) -> None:
        self._bus.close()


class RecordedSource:
    """As fast as it can be looked at."""

    def __init__(self, recording: Recording, *, inertia: bool) -> None:
        self.name = recording.path.name
        self.ended = False
        wanted = (topics.STEREO, topics.PROPRIOCEPTION) if inertia else (topics.STEREO,)
        self._messages = recording.messages(*wanted)

    def take(self, feel: Callable[[ImuBatch], None], wait: float) -> StereoFrame | None:
        for _, _, message in self._messages:
            if isinstance(message, StereoFrame):
                return message
            feel(message.imu)
        self.ended = True
        return None

    def close(self) -> None:
        self._messages = iter(())
