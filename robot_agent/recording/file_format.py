"""What a recording is made of: an MCAP file whose channels are the bus's keys and whose data are the bus's bytes.

A metadata record says who was recorded and when, an attachment holds the robot as it was configured, and every
channel's schema spells out its message's fields. Log times are the robot's clock as a message came in, publish times
the message's own stamp.
"""

from __future__ import annotations

import dataclasses
import json
import typing
from dataclasses import dataclass
from typing import Any

import msgspec

from weaver_shared import codec
from weaver_shared.errors import InputError

PROFILE = "weaver"
MESSAGE_ENCODING = "msgpack"
SCHEMA_ENCODING = "weaver"
ABOUT = "weaver"
"""Name of the metadata record."""
ROBOT = "robot.json"
"""Name of the attachment with the resolved robot description."""
SUFFIX = ".mcap"


@dataclass(frozen=True, slots=True, kw_only=True)
class About:
    """Who was recorded, when and by what."""

    robot_id: str
    started: str  # wall time, ISO 8601
    software: str  # version of this package
    pictures: bool  # whether the stereo pairs are in the file

    def to_metadata(self) -> dict[str, str]:
        return {
            "robot_id": self.robot_id,
            "started": self.started,
            "software": self.software,
            "pictures": "yes" if self.pictures else "no",
            "schema": str(codec.SCHEMA_VERSION),
        }

    @staticmethod
    def of_metadata(entries: dict[str, str], source: str) -> About:
        """Raises InputError for a recording of another schema."""
        schema = entries.get("schema", "missing")
        if schema != str(codec.SCHEMA_VERSION):
            raise InputError(
                f"{source} was recorded with message schema {schema}, this version reads {codec.SCHEMA_VERSION}; "
                f"read it with version {entries.get('software', 'unknown')}"
            )
        return About(
            robot_id=entries.get("robot_id", ""),
            started=entries.get("started", ""),
            software=entries.get("software", ""),
            pictures=entries.get("pictures") == "yes",
        )


def schema_of(kind: type[Any]) -> bytes:
    """The fields of a message in wire order, as the text that goes into the file."""
    hints = typing.get_type_hints(kind)
    fields = {field.name: _type_name(hints[field.name]) for field in dataclasses.fields(kind)}
    return msgspec.json.encode({"schema": codec.SCHEMA_VERSION, "message": kind.__name__, "fields": fields})


def check_schema(recorded: bytes, kind: type[Any], source: str) -> None:
    """Raises InputError where a message was recorded with other fields than it has now."""
    ours = json.loads(schema_of(kind))
    try:
        theirs = json.loads(recorded)
    except ValueError:
        theirs = {}
    if theirs != ours:
        names = ", ".join(theirs.get("fields", {})) if isinstance(theirs, dict) else ""
        raise InputError(
            f"{source} was recorded by another version: its {kind.__name__} has the fields {names or 'of nobody'}, "
            f"ours {', '.join(ours['fields'])}"
        )


def _type_name(hint: Any) -> str:
    if isinstance(hint, type) and typing.get_origin(hint) is None:
        return hint.__name__
    return str(hint).replace("weaver_shared.messages.", "")
