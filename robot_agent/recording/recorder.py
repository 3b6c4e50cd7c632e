"""Listens to a robot on the bus and writes down all it says; whoever speaks never waits for the disk."""

from __future__ import annotations

import threading
from collections import deque
from typing import Any

from robot_agent.recording.writer import RecordingWriter
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.messages import Heartbeat, StereoFrame
from weaver_shared.topics import TOPICS, Topic

MOST_PICTURES_WAITING = 40
MOST_WAITING = 20_000
"""Messages that wait for a slow disk; later ones are lost and counted."""


def recorded_topics(*, pictures: bool) -> tuple[Topic, ...]:
    """All but the scene, which a simulator tells its renderer alone, and what recorders tell of themselves."""
    left_out = {topics.SCENE.key, topics.RECORDING.key} | (set() if pictures else {topics.STEREO.key})
    return tuple(topic for topic in TOPICS if topic.key not in left_out)


class Recorder:
    """`turn` writes what has come in since the last one: from one thread, and several times a second."""

    def __init__(self, bus: Bus, robot_id: str, writer: RecordingWriter, *, pictures: bool = True) -> None:
        self._writer = writer
        self._arrived = threading.Condition()
        self._waiting: deque[tuple[str, Any]] = deque()
        self._pictures_waiting = 0
        self._lost = 0
        self._session = ""
        self.restarted = False
        """Whether the robot has been started anew, and its clock with it, since the recording began."""
        for topic in recorded_topics(pictures=pictures):
            bus.subscribe(robot_id, topic, self._receive)

    @property
    def lost(self) -> int:
        """Messages that were not written because the disk was too slow."""
        with self._arrived:
            return self._lost

    def turn(self, wait: float = 0.0) -> None:
        """Write all that waits; `wait` at most so many s for something to come. Raises ResourceError of a full disk."""
        with self._arrived:
            if not self._waiting and wait > 0.0:
                self._arrived.wait(wait)
            waiting, self._waiting = self._waiting, deque()
            self._pictures_waiting = 0
        for key, message in waiting:
            if isinstance(message, Heartbeat):
                self.restarted |= self._session not in ("", message.session)
                self._session = message.session
            self._writer.write(key, message)
        self._writer.keep_safe()

    def _receive(self, _robot_id: str, key: str, message: Any) -> None:
        picture = isinstance(message, StereoFrame)
        with self._arrived:
            if len(self._waiting) >= MOST_WAITING or (picture and self._pictures_waiting >= MOST_PICTURES_WAITING):
                self._lost += 1
                return
            self._pictures_waiting += picture
            self._waiting.append((key, message))
            self._arrived.notify()
