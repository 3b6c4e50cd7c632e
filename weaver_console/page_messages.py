"""What the page may say, checked at the door (docs/console_protocol.md)."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec

from weaver_shared.errors import MessageError
from weaver_shared.messages import CommandName

LARGEST_FRAME = 256 * 1024
MOST_WAYPOINTS = 1000
MOST_TAKEN = 1000
"""Frames that a page may report at once."""


class Place(msgspec.Struct, frozen=True, kw_only=True):
    """A waypoint in world, m."""

    x: float
    y: float


class Select(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="select"):
    robot: str | None


class CommandRequest(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="command"):
    id: str
    command: CommandName
    robot: str | None = None
    name: str = ""
    value: float = 0.0
    seconds: float = 0.0
    reason: str = ""
    waypoints: list[Place] = []


class Retain(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="retain"):
    pass


class Teleoperation(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="teleop"):
    forward: float
    left: float
    turn: float
    dead_man: bool


class Draft(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="draft"):
    waypoints: list[Place]
    selected: int | None = None
    areas: Annotated[list[Annotated[list[Place], msgspec.Meta(max_length=400)]], msgspec.Meta(max_length=50)] = []


class ChooseLayer(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="layer"):
    name: str


class View(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="view"):
    follow: bool | None = None
    truth: bool | None = None
    frusta: bool | None = None
    trail: bool | None = None
    contours: bool | None = None
    torques: bool | None = None


class Measure(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="measure"):
    """The places that are measured between, in world."""

    places: Annotated[list[Place], msgspec.Meta(max_length=2)]


class Watch(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="watch"):
    cameras: bool
    features: bool = False


class AskForControl(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="ask_for_control"):
    reason: str = ""


class AnswerRequest(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="answer_request"):
    asker: str
    grant: bool


class Ping(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="ping"):
    t: float


class Taken(msgspec.Struct, frozen=True, kw_only=True, tag_field="type", tag="taken"):
    """The page has taken in so many more frames."""

    frames: Annotated[int, msgspec.Meta(ge=1, le=MOST_TAKEN)] = 1


PageMessage = (
    AskForControl
    | AnswerRequest
    | Select
    | CommandRequest
    | Retain
    | Teleoperation
    | Draft
    | ChooseLayer
    | View
    | Measure
    | Watch
    | Ping
    | Taken
)

_decoder: msgspec.json.Decoder[Any] = msgspec.json.Decoder(PageMessage)


def read_page_message(data: str | bytes) -> PageMessage:
    """One frame from the page. Raises MessageError with what is wrong."""
    if len(data) > LARGEST_FRAME:
        raise MessageError(f"a frame may have {LARGEST_FRAME // 1024} kB, this one has {len(data) // 1024}")
    try:
        message: PageMessage = _decoder.decode(data)
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        raise MessageError(f"the message was not understood: {error}") from error
    places = getattr(message, "waypoints", [])
    if len(places) > MOST_WAYPOINTS:
        raise MessageError(f"a mission has at most {MOST_WAYPOINTS} waypoints, this one has {len(places)}")
    return message
