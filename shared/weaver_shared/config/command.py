"""Limits of what an operator may ask for."""

from pydantic import BaseModel, ConfigDict


class CommandLimits(BaseModel):
    """Times in s, distances in m."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    waypoint_reach: float = 30.0  # farther from the robot than this is a slip of the hand
    waypoint_count: int = 100
    stuck_seconds: float = 30.0  # without making way, after which a mission pauses
    teleop_silence: float = 0.3
    override_seconds: float = 3600.0
    cruise_seconds: float = 600.0
    teleop_forward: float = 0.25  # m/s at full stick
    teleop_left: float = 0.10
    teleop_turn: float = 0.5  # rad/s
