"""The one table of what travels: key, message, rate, priority and policy. Recorder, console and docs derive from it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Generic, TypeVar

from weaver_shared import messages as m
from weaver_shared.errors import ConfigurationError

Q = TypeVar("Q")
A = TypeVar("A")

ROOT = "weaver"


class Policy(StrEnum):
    LATEST = "latest"  # a lost or late sample does not matter, the next one replaces it
    RELIABLE = "reliable"  # late joiners get the last one
    LOGGED = "logged"  # each one counts


class Priority(StrEnum):
    REAL_TIME = "real_time"
    INTERACTIVE = "interactive"
    DATA = "data"
    BACKGROUND = "background"


@dataclass(frozen=True, slots=True, kw_only=True)
class Topic:
    """`key` lies under `weaver/{robot_id}/`; braces in it are filled by `at()`."""

    key: str
    message: type[Any]
    rate: float  # Hz, 0 = on change
    priority: Priority
    policy: Policy

    def at(self, **parts: object) -> str:
        return self.key.format(**parts)

    @property
    def pattern(self) -> str:
        """The key with every brace as a wildcard."""
        head, brace, _ = self.key.partition("{")
        return f"{head}**" if brace else head


@dataclass(frozen=True, slots=True, kw_only=True)
class Query(Generic[Q, A]):
    """A question to one process of a robot, under `weaver/{robot_id}/`; `refuse` makes an answer of a reason."""

    key: str
    question: type[Q]
    answer: type[A]
    priority: Priority
    refuse: Callable[[str], A]


def _topic(key: str, message: type[Any], rate: float, priority: Priority, policy: Policy) -> Topic:
    return Topic(key=key, message=message, rate=rate, priority=priority, policy=policy)


HEARTBEAT = _topic("hb", m.Heartbeat, 20.0, Priority.REAL_TIME, Policy.LATEST)
STATE = _topic("tele/state", m.RobotState, 50.0, Priority.INTERACTIVE, Policy.LATEST)
GAIT = _topic("tele/gait", m.GaitState, 20.0, Priority.INTERACTIVE, Policy.LATEST)
LOCOMOTION = _topic("tele/locomotion", m.LocomotionState, 20.0, Priority.INTERACTIVE, Policy.LATEST)
ADAPTATION = _topic("tele/adaptation", m.AdaptationReport, 10.0, Priority.INTERACTIVE, Policy.LATEST)
SERVOS = _topic("tele/servos", m.ServoStates, 5.0, Priority.DATA, Policy.LATEST)
POWER = _topic("tele/power", m.PowerState, 5.0, Priority.DATA, Policy.LATEST)
HEALTH = _topic("tele/health/{process}", m.Health, 2.0, Priority.DATA, Policy.LATEST)
MAP_TILE = _topic("tele/map/tile/{i}_{j}", m.MapTile, 5.0, Priority.BACKGROUND, Policy.RELIABLE)
CAMERA = _topic("tele/cam/{name}", m.CameraPicture, 5.0, Priority.BACKGROUND, Policy.LATEST)
FEATURES = _topic("tele/features/{name}", m.TrackedFeatures, 5.0, Priority.BACKGROUND, Policy.LATEST)
ODOMETRY = _topic("tele/odometry", m.OdometryEstimate, 20.0, Priority.REAL_TIME, Policy.LATEST)
TERRAIN = _topic("tele/terrain", m.TerrainEstimate, 10.0, Priority.DATA, Policy.LATEST)
DESIRED_GAIT = _topic("tele/desired_gait", m.AdaptationReport, 10.0, Priority.INTERACTIVE, Policy.LATEST)
ROUTE = _topic("tele/route", m.RoutePlan, 2.0, Priority.DATA, Policy.RELIABLE)
GOAL = _topic("state/goal", m.NavigationGoal, 2.0, Priority.DATA, Policy.RELIABLE)
PERCEPTION = _topic("state/perception", m.PerceptionOrder, 1.0, Priority.DATA, Policy.RELIABLE)
MODE = _topic("state/mode", m.ModeState, 5.0, Priority.INTERACTIVE, Policy.RELIABLE)
MOTION = _topic("state/motion", m.MotionOrders, 5.0, Priority.INTERACTIVE, Policy.RELIABLE)
LEASE = _topic("state/lease", m.LeaseState, 5.0, Priority.INTERACTIVE, Policy.RELIABLE)
MISSION = _topic("state/mission", m.MissionState, 5.0, Priority.INTERACTIVE, Policy.RELIABLE)
AREAS = _topic("state/areas", m.ForbiddenAreas, 1.0, Priority.DATA, Policy.RELIABLE)
OUTLOOK = _topic("state/outlook", m.MissionOutlook, 2.0, Priority.DATA, Policy.RELIABLE)
RECORDING = _topic("state/recording", m.RecordingState, 1.0, Priority.DATA, Policy.RELIABLE)
REPLAY = _topic("state/replay", m.ReplayState, 10.0, Priority.INTERACTIVE, Policy.RELIABLE)
REPLAY_MARKS = _topic("state/replay_marks", m.ReplayMarks, 0.0, Priority.DATA, Policy.RELIABLE)
CALIBRATION = _topic("state/calibration", m.CalibrationState, 2.0, Priority.DATA, Policy.RELIABLE)
PRESENCE = _topic("state/presence", m.Presence, 1.0, Priority.DATA, Policy.RELIABLE)
EVENT = _topic("event", m.Event, 0.0, Priority.DATA, Policy.LOGGED)
TELEOP = _topic("teleop", m.TeleopFrame, 20.0, Priority.REAL_TIME, Policy.LATEST)
STEREO = _topic("sensor/stereo", m.StereoFrame, 20.0, Priority.DATA, Policy.LATEST)
PROPRIOCEPTION = _topic("sensor/body", m.Proprioception, 100.0, Priority.INTERACTIVE, Policy.LATEST)
SCENE = _topic("sim/scene", m.SceneState, 20.0, Priority.INTERACTIVE, Policy.LATEST)
TRUTH = _topic("truth/state", m.TruthState, 50.0, Priority.DATA, Policy.LATEST)

TOPICS: tuple[Topic, ...] = tuple(value for value in list(globals().values()) if isinstance(value, Topic))


def _refused(reason: str) -> m.Answer:
    return m.Answer(accepted=False, reason=reason)


def _no_part(reason: str) -> m.RecordingPart:
    return m.RecordingPart(data=b"", size=0, reason=reason)


COMMANDS = Query(key="cmd", question=m.Command, answer=m.Answer, priority=Priority.REAL_TIME, refuse=_refused)
RECORDER_COMMANDS = Query(
    key="cmd/recorder", question=m.Command, answer=m.Answer, priority=Priority.INTERACTIVE, refuse=_refused
)
REPLAY_COMMANDS = Query(
    key="cmd/replay", question=m.Command, answer=m.Answer, priority=Priority.INTERACTIVE, refuse=_refused
)
VISION_COMMANDS = Query(
    key="cmd/vision", question=m.Command, answer=m.Answer, priority=Priority.INTERACTIVE, refuse=_refused
)
CALIBRATOR_COMMANDS = Query(
    key="cmd/calibrator", question=m.Command, answer=m.Answer, priority=Priority.INTERACTIVE, refuse=_refused
)
CALIBRATION_PART = Query(
    key="calibration/part",
    question=m.PartRequest,
    answer=m.RecordingPart,
    priority=Priority.BACKGROUND,
    refuse=_no_part,
)
RECORDING_PART = Query(
    key="recording/part",
    question=m.PartRequest,
    answer=m.RecordingPart,
    priority=Priority.BACKGROUND,
    refuse=_no_part,
)


QUERIES: tuple[Query[Any, Any], ...] = (
    COMMANDS,
    RECORDER_COMMANDS,
    RECORDING_PART,
    REPLAY_COMMANDS,
    CALIBRATOR_COMMANDS,
    CALIBRATION_PART,
    VISION_COMMANDS,
)


def robot_key(robot_id: str, key: str) -> str:
    """Full key of a robot's topic. Raises ConfigurationError on an id that can not be one key segment."""
    if not robot_id or not all(c.isalnum() or c in "-_" for c in robot_id):
        raise ConfigurationError(f"robot id {robot_id!r} is not valid; use letters, digits, - and _")
    return f"{ROOT}/{robot_id}/{key}"


def topic_of(key: str) -> Topic:
    """The topic whose pattern `key` (without the robot's prefix) matches. Raises ConfigurationError if none does."""
    for topic in TOPICS:
        if key == topic.key or ("{" in topic.key and key.startswith(topic.key.partition("{")[0])):
            return topic
    raise ConfigurationError(f"key {key!r} is not in the table of topics")
