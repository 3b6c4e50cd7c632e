"""Reads recordings back, also such as were cut off: all that is whole before the cut."""

from __future__ import annotations

import logging
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import zstandard
from mcap.exceptions import InvalidMagic, McapError
from mcap.records import Attachment, Channel, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import CRCValidationError, StreamReader
from pydantic import ValidationError

from robot_agent.recording.file_format import ABOUT, ROBOT, SUFFIX, About, check_schema
from robot_agent.recording.packed_pictures import PackedStereoFrame, unpack
from weaver_shared import codec, topics
from weaver_shared.errors import InputError, MessageError
from weaver_shared.robots import RobotDescription
from weaver_shared.topics import Topic, robot_key

logger = logging.getLogger(__name__)

LARGEST_RECORD = 256 * 1024 * 1024
DAMAGE = (McapError, CRCValidationError, struct.error, zstandard.ZstdError, UnicodeDecodeError, MemoryError)
"""What a record that is not whole makes the reader raise."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Recording:
    """A file that can be read; messages are only read when they are asked for."""

    path: Path
    about: About
    robot: RobotDescription

    def messages(self, *wanted: Topic) -> Iterator[tuple[int, str, Any]]:
        """When it came (ns, robot's clock), key under the robot, and message, in the order they came.

        Raises InputError where a message has other fields than ours. A file that was cut off ends where it was cut,
        with a warning.
        """
        keys = {robot_key(self.about.robot_id, topic.key.partition("{")[0]): topic for topic in wanted}
        prefix = len(robot_key(self.about.robot_id, ""))
        schemas: dict[int, Schema] = {}
        kinds: dict[int, tuple[str, type[Any]]] = {}
        for record in _records(self.path):
            match record:
                case Schema():
                    schemas[record.id] = record
                case Channel():
                    topic = next((t for key, t in keys.items() if _lies_under(record.topic, key, t)), None)
                    if topic is not None and record.id not in kinds:
                        kind = _recorded_kind(topic)
                        check_schema(schemas[record.schema_id].data, kind, str(self.path))
                        kinds[record.id] = record.topic[prefix:], kind
                case Message() if record.channel_id in kinds:
                    key, kind = kinds[record.channel_id]
                    yield record.log_time, key, self._decode(record.data, kind)

    def _decode(self, data: bytes, kind: type[Any]) -> Any:
        try:
            message = codec.decode(data, kind)
        except MessageError as error:
            raise InputError(f"{self.path} has a damaged message: {error}") from error
        return unpack(message) if isinstance(message, PackedStereoFrame) else message


def is_recording(path: Path) -> bool:
    return path.is_file() or path.suffix == SUFFIX


def open_recording(path: Path) -> Recording:
    """Raises InputError that says what is wrong with the file."""
    about: About | None = None
    robot: RobotDescription | None = None
    for record in _records(path, to_the_end=False):
        match record:
            case Metadata() if record.name == ABOUT:
                about = About.of_metadata(record.metadata, str(path))
            case Attachment() if record.name == ROBOT:
                robot = _robot(record.data, path)
        if about is not None and robot is not None:
            return Recording(path=path, about=about, robot=robot)
    raise InputError(f"{path} is not a recording of ours: it does not say which robot was recorded")


def _records(path: Path, *, to_the_end: bool = True) -> Iterator[McapRecord]:
    try:
        with path.open("rb") as stream:
            try:
                yield from StreamReader(stream, validate_crcs=True, record_size_limit=LARGEST_RECORD).records
            except InvalidMagic as error:
                if stream.tell() <= 8:
                    raise InputError(f"{path} is not an MCAP recording") from error
                logger.warning("%s has no proper end; all of it was read", path)
            except DAMAGE:
                if stream.tell() <= 8:
                    raise InputError(f"{path} is not an MCAP recording") from None
                if to_the_end:
                    logger.warning("%s was cut off; what is whole before the cut was read", path)
    except OSError as error:
        raise InputError(f"{path} can not be read: {error.strerror}") from error


def _recorded_kind(topic: Topic) -> type[Any]:
    return PackedStereoFrame if topic is topics.STEREO else topic.message


def _lies_under(key: str, wanted: str, topic: Topic) -> bool:
    return key.startswith(wanted) if "{" in topic.key else key == wanted


def _robot(data: bytes, path: Path) -> RobotDescription:
    try:
        return RobotDescription.model_validate_json(data)
    except ValidationError as error:
        where = ".".join(str(part) for part in error.errors()[0]["loc"])
        raise InputError(f"{path} was recorded by another version: its robot's {where} is not as ours") from error
