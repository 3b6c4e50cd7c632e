"""What a robot's recorder tells, and hands out of its files."""

from dataclasses import dataclass

from weaver_shared.messages.telemetry import Severity


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingEntry:
    """One file that is not being written any more."""

    name: str
    started: str  # wall time, ISO 8601
    seconds: float  # of the robot's time
    size: int  # B
    pictures: bool
    whole: bool  # False: cut off by a crash; what is before the cut can be read


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingState:
    """The recording that runs, if any, and those that are there, newest first."""

    active: str  # name of the file being written, empty when none is
    seconds: float  # of the robot's time in it
    size: int  # B in it
    pictures: bool
    lost: int  # messages that a slow disk had no room for
    reason: str  # why the last one ended by itself; empty when it was stopped
    folder: str  # on the robot
    free: int  # B on its disk
    entries: tuple[RecordingEntry, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class PartRequest:
    """Asks for `length` B of a recording from `offset` on."""

    name: str
    offset: int
    length: int


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordingPart:
    data: bytes
    size: int  # B of the whole file
    reason: str  # why there is nothing; empty when there is


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayState:
    """Where the replay of a recording is, 10 Hz. A replay speaks as a robot of its own, of the kind REPLAY."""

    stamp_ns: int  # recorded robot's clock
    recording: str  # name of the file
    robot_id: str  # who was recorded
    started: str  # when, wall time, ISO 8601
    seconds: float  # from the recording's beginning
    length: float  # s
    speed: float  # recorded s a second; 0 paused


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayMark:
    """An event of the recording, to go to."""

    seconds: float  # from the recording's beginning
    severity: Severity
    source: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayMarks:
    marks: tuple[ReplayMark, ...]  # by time
