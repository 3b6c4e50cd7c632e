"""Settings of the path follower (ICRA'17 III-B)."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0.0)]


class PathFollowerConfig(BaseModel):
    """Distances in m, speeds in m/s and rad/s, angles in rad. Only `acceptance_radius` is stated in the paper."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    acceptance_radius: Positive = 0.5  # R
    forward_speed: Positive = 0.30  # V_x,max; the gait's own limits come on top
    side_speed: Positive = 0.10  # V_y,max
    turn_gain: Positive = 0.8  # K_rot, 1/s
    turn_rate: Positive = 0.4
    side_angle: Positive = 0.35  # alpha_e0, 20 degrees
    goal_radius: Positive = 0.10  # from the last waypoint, within which the mission is done
    goal_gain: Positive = 0.8  # 1/s, slows the last steps
    slowest: Positive = 0.03  # m/s, of the last steps
