"""Everything that crosses a process border, as frozen dataclasses. Arrays are row-major; units are SI unless named."""

from weaver_shared.messages.calibration import (
    CalibrationState,
    CalibrationWish,
)
from weaver_shared.messages.commands import (
    Answer,
    Command,
    CommandName,
    TeleopFrame,
)
from weaver_shared.messages.estimation import (
    AdaptationReport,
    GaitParameters,
    MapTile,
    NavigationGoal,
    OdometryEstimate,
    OdometryQuality,
    RoutePlan,
    TerrainEstimate,
    Waypoint,
)
from weaver_shared.messages.recording import (
    PartRequest,
    RecordingEntry,
    RecordingPart,
    RecordingState,
)
from weaver_shared.messages.sensing import (
    CameraPicture,
    ImuBatch,
    Proprioception,
    StereoFrame,
)
from weaver_shared.messages.simulation import (
    SceneState,
)
from weaver_shared.messages.telemetry import (
    Event,
    GaitState,
    Health,
    Heartbeat,
    LeaseState,
    LocomotionState,
    LoopTiming,
    MissionState,
    ModeState,
    MotionOrders,
    PowerState,
    Presence,
    RobotState,
    SafetyAction,
    Severity,
    TruthState,
)

__all__ = [
    "AdaptationReport",
    "Answer",
    "CalibrationState",
    "CalibrationWish",
    "CameraPicture",
    "Command",
    "CommandName",
    "Event",
    "GaitParameters",
    "GaitState",
    "Health",
    "Heartbeat",
    "ImuBatch",
    "LeaseState",
    "LocomotionState",
    "LoopTiming",
    "MapTile",
    "MissionState",
    "ModeState",
    "MotionOrders",
    "NavigationGoal",
    "OdometryEstimate",
    "OdometryQuality",
    "PartRequest",
    "PowerState",
    "Presence",
    "Proprioception",
    "RecordingEntry",
    "RecordingPart",
    "RecordingState",
    "RobotState",
    "RoutePlan",
    "SafetyAction",
    "SceneState",
    "Severity",
    "StereoFrame",
    "TeleopFrame",
    "TerrainEstimate",
    "TruthState",
    "Waypoint",
]
