"""Writes a recording so that a crash at any moment loses at most its last half second."""

from __future__ import annotations

import os
from importlib.metadata import version
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, Writer

from robot_agent.recording.file_format import ABOUT, MESSAGE_ENCODING, PROFILE, ROBOT, SCHEMA_ENCODING, About, schema_of
from robot_agent.recording.packed_pictures import PicturePacker
from weaver_shared import codec
from weaver_shared.clock import Clock
from weaver_shared.errors import ResourceError
from weaver_shared.messages import StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.topics import Policy, robot_key, topic_of

CHUNK_BYTES = 256 * 1024
HANDED_OVER_NS = 500_000_000
"""What is older has been handed to the system: it outlives this process."""
ON_DISK_NS = 5_000_000_000
"""What is older is on the disk: it outlives the computer."""


class RecordingWriter:
    """One file; not to be used from two threads at once. Raises ResourceError when the disk does not take it."""

    def __init__(
        self, path: Path, *, robot_id: str, robot: RobotDescription, clock: Clock, started: str, pictures: bool = True
    ) -> None:
        """`started` is the wall time for the file; `clock` says when it is time to flush."""
        self.path = path
        self._robot_id = robot_id
        self._clock = clock
        self._packer = PicturePacker()
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        self._first_ns: int | None = None
        self._newest_ns = 0
        self._early: list[tuple[str, Any]] = []
        """What is kept for late joiners, and was said long ago: written down when the robot's clock is first heard."""
        self._flushed_ns = self._synced_ns = clock.now_ns()
        about = About(robot_id=robot_id, started=started, software=version("weaver-hexapod"), pictures=pictures)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._stream = path.open("xb")
        except FileExistsError as error:
            raise ResourceError(f"{path} exists already; a recording is never written over") from error
        except OSError as error:
            raise ResourceError(f"{path} can not be written: {error.strerror}") from error
        self._writer = Writer(self._stream, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD)
        self._writer.start(profile=PROFILE)
        self._writer.add_metadata(ABOUT, about.to_metadata())
        text = robot.model_dump_json(by_alias=True).encode()
        self._writer.add_attachment(0, 0, ROBOT, "application/json", text)
        self._flush()

    @property
    def seconds(self) -> float:
        """How much of the robot's time is in the file."""
        return 0.0 if self._first_ns is None else (self._newest_ns - self._first_ns) * 1e-9

    @property
    def newest_ns(self) -> int:
        """The latest stamp of the robot's clock that was heard."""
        return self._newest_ns

    @property
    def size(self) -> int:
        """Bytes in the file, without what is still gathered for its next chunk."""
        return self._stream.tell()

    def write(self, key: str, message: Any) -> None:
        """Take a message in; `key` lies under the robot's."""
        stamp_ns: int | None = getattr(message, "stamp_ns", None)
        if self._first_ns is None:
            if stamp_ns is None or topic_of(key).policy is not Policy.LATEST:
                self._early.append((key, message))
                return
            self._first_ns = self._newest_ns = max(stamp_ns, 0)
            self._put_early()
        self._newest_ns = max(self._newest_ns, stamp_ns or 0)
        self._put(key, message)

    def _put_early(self) -> None:
        early, self._early = self._early, []
        for key, message in early:
            self._put(key, message)

    def _put(self, key: str, message: Any) -> None:
        if isinstance(message, StereoFrame):
            message = self._packer.pack(message)
        try:
            self._writer.add_message(
                self._channel(key, type(message)),
                log_time=self._newest_ns,
                publish_time=max(getattr(message, "stamp_ns", self._newest_ns), 0),
                data=codec.encode(message),
            )
        except OSError as error:
            raise ResourceError(f"{self.path} can not be written on: {error.strerror}") from error

    def keep_safe(self) -> None:
        """Hand over what has waited for long enough; to be called several times a second."""
        now_ns = self._clock.now_ns()
        if now_ns - self._flushed_ns >= HANDED_OVER_NS:
            self._flushed_ns = now_ns
            self._flush()
        if now_ns - self._synced_ns >= ON_DISK_NS:
            self._synced_ns = now_ns
            os.fsync(self._stream.fileno())

    def close(self) -> None:
        self._put_early()
        try:
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._stream.close()
        except OSError as error:
            raise ResourceError(f"{self.path} can not be completed: {error.strerror}") from error

    def _channel(self, key: str, kind: type[Any]) -> int:
        channel = self._channels.get(key)
        if channel is None:
            schema = self._schemas.get(kind.__name__)
            if schema is None:
                schema = self._writer.register_schema(kind.__name__, SCHEMA_ENCODING, schema_of(kind))
                self._schemas[kind.__name__] = schema
            channel = self._writer.register_channel(robot_key(self._robot_id, key), MESSAGE_ENCODING, schema)
            self._channels[key] = channel
        return channel

    def _flush(self) -> None:
        try:
            self._writer.flush()  # type: ignore[no-untyped-call]
        except OSError as error:
            raise ResourceError(f"{self.path} can not be written on: {error.strerror}") from error
