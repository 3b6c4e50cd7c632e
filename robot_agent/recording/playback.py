"""A recording as something to go about in: what was said between two moments, and what held at one."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robot_agent.recording.file_format import check_schema
from robot_agent.recording.message_index import MessageIndex
from robot_agent.recording.reader import Recording, open_recording
from weaver_shared import codec, topics
from weaver_shared.errors import ConfigurationError, InputError, MessageError
from weaver_shared.messages import Event, Presence, ReplayMark, Severity
from weaver_shared.topics import Topic, robot_key, topic_of

SHOWN_UNDER = ("tele/", "state/", "truth/")
OWN = {topics.PRESENCE.key, topics.RECORDING.key, topics.REPLAY.key, topics.REPLAY_MARKS.key}
"""What a replay says of itself."""

MOST_MARKS = 400


@dataclass(frozen=True, slots=True, kw_only=True)
class Said:
    """One recorded message, with what fills the braces of its topic's key."""

    time_ns: int  # robot's clock as it came
    topic: Topic
    parts: dict[str, str]
    message: Any


class Playback:
    """Raises InputError where the file can not be read, or is of another version."""

    def __init__(self, path: Path) -> None:
        self.recording: Recording = open_recording(path)
        self._index = MessageIndex(path)
        if not len(self._index):
            raise InputError(f"{path} has no messages to replay")
        self._kinds = self._shown_channels()
        self.first_ns, self.last_ns = int(self._index.times[0]), int(self._index.times[-1])

    @property
    def seconds(self) -> float:
        return (self.last_ns - self.first_ns) * 1e-9

    def close(self) -> None:
        self._index.close()

    def between(self, after_ns: int, until_ns: int) -> Iterator[Said]:
        """What came later than the one and not later than the other moment (ns, robot's clock), in its order."""
        return self._said(range(self._index.until(after_ns), self._index.until(until_ns)))

    def held_at(self, time_ns: int) -> Iterator[Said]:
        """The newest message of each key by then."""
        return self._said(self._index.newest(self._index.until(time_ns)))

    def presence(self) -> Presence | None:
        """Who was recorded."""
        return next((said.message for said in self._of(topics.PRESENCE)), None)

    def marks(self) -> tuple[ReplayMark, ...]:
        """The events of the recording, by their times; of very many those that warn and the last others."""
        events: list[tuple[int, Event]] = [(said.time_ns, said.message) for said in self._of(topics.EVENT)]
        if len(events) > MOST_MARKS:
            events.sort(key=lambda entry: (entry[1].severity is Severity.INFO, -entry[0]))
            events = sorted(events[:MOST_MARKS], key=lambda entry: entry[0])
        return tuple(
            ReplayMark(
                seconds=(time_ns - self.first_ns) * 1e-9, severity=event.severity, source=event.source, text=event.text
            )
            for time_ns, event in events
        )

    def _of(self, topic: Topic) -> Iterator[Said]:
        for channel, (kind, parts) in self._channels(lambda key: key == topic.key).items():
            for number in (self._index.channel_of == channel).nonzero()[0]:
                message = self._decode(self._index.data(int(number)), kind)
                time_ns = int(self._index.times[number])
                yield Said(time_ns=time_ns, topic=kind, parts=parts, message=message)

    def _said(self, numbers: Iterator[int] | range | list[int]) -> Iterator[Said]:
        for number in numbers:
            shown = self._kinds.get(int(self._index.channel_of[number]))
            if shown is not None:
                topic, parts = shown
                message = self._decode(self._index.data(number), topic)
                time_ns = int(self._index.times[number])
                yield Said(time_ns=time_ns, topic=topic, parts=parts, message=message)

    def _decode(self, data: bytes, topic: Topic) -> Any:
        try:
            return codec.decode(data, topic.message)
        except MessageError as error:
            raise InputError(f"{self.recording.path} has a damaged message: {error}") from error

    def _shown_channels(self) -> dict[int, tuple[Topic, dict[str, str]]]:
        return self._channels(lambda key: key.startswith(SHOWN_UNDER) and key not in OWN)

    def _channels(self, wanted: Any) -> dict[int, tuple[Topic, dict[str, str]]]:
        prefix = robot_key(self.recording.about.robot_id, "")
        found: dict[int, tuple[Topic, dict[str, str]]] = {}
        for number, channel in self._index.channels.items():
            key = channel.topic.removeprefix(prefix)
            if not wanted(key):
                continue
            try:
                topic = topic_of(key)
            except ConfigurationError:
                continue  # of a version that said more
            check_schema(self._index.schemas[channel.schema_id].data, topic.message, str(self.recording.path))
            found[number] = topic, parts_of(topic, key)
        return found


def parts_of(topic: Topic, key: str) -> dict[str, str]:
    """What fills the braces of the topic's key in this one."""
    pattern = re.sub(r"\\\{(\w+)\\\}", r"(?P<\1>.+)", re.escape(topic.key))
    match = re.fullmatch(pattern, key)
    return {} if match is None else match.groupdict()
