"""Everything that crosses a process border, as frozen dataclasses. Arrays are row-major; units are SI unless named."""

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
    OdometryEstimate,
    OdometryQuality,
    TerrainEstimate,
    Waypoint,
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
    "OdometryEstimate",
    "OdometryQuality",
    "PowerState",
    "Presence",
    "Proprioception",
    "RobotState",
    "SafetyAction",
    "SceneState",
    "Severity",
    "StereoFrame",
    "TeleopFrame",
    "TerrainEstimate",
    "TruthState",
    "Waypoint",
]
