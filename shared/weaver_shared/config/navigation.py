"""Settings of the path follower (ICRA'17 III-B)."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0.0)]


class PathFollowerConfig(BaseModel):
    """Distances in m, speeds in m/s and rad/s, angles in rad. Only `acceptance_radius` is stated in the paper."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    acceptance_radius: Positive = 0.5  # R
    forward_speed: Positive = 0.35  # V_x,max (Weaver's fastest); the gait's own limits come on top
    side_speed: Positive = 0.10  # V_y,max
    turn_gain: Positive = 1.2  # K_rot, 1/s
    turn_rate: Positive = 0.4
    turn_first: tuple[Positive, Positive] = (0.5, 1.0)  # rad of course error from which V_x falls, and at which it is 0
    side_angle: Positive = 0.35  # alpha_e0, 20 degrees
    goal_radius: Positive = 0.10  # from the last waypoint, within which the mission is done
    goal_gain: Positive = 0.8  # 1/s, slows the last steps
    slowest: Positive = 0.03  # m/s, of the last steps


class FenceConfig(BaseModel):
    """How a steered robot is slowed before a forbidden area. Lengths in m, speeds in m/s."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    stop_short: Positive = 0.05  # between the feet's circle and the area: about half a stride
    approach: Positive = 0.8  # 1/s, speed towards the area for the distance left
    slowest: Positive = 0.02  # below it the robot stands
    along: Positive = 0.17  # of a motion beside an area that may lead nearer, 10 degrees: hands are not exact


class RouteConfig(BaseModel):
    """How a way is looked for on the terrain map. Lengths in m; weights are added to the cost 1 of plain ground."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    cell: Positive = 0.08
    margin: Positive = 4.0  # beyond start and goal in which a way may lead
    highest_step: Positive = 0.20  # between neighbouring cells; more is an obstacle
    step_weight: Positive = 2.0  # at the highest step
    roughness_weight: Positive = 1.0  # at roughness 1
    slope_weight: Positive = 1.0  # at 45 degrees
    unknown_weight: Positive = 0.6
    clearance: Positive = 0.05  # between the feet's circle and an obstacle
    comfort: Positive = 0.30  # beyond it, in which obstacles still cost
    comfort_weight: Positive = 4.0
    keep_factor: Annotated[float, Field(ge=1.0)] = 1.15  # a route is kept until another costs this much less
    every: Annotated[int, Field(ge=1)] = 4  # perceived pictures from one search to the next
    patience: Positive = 3.0  # s without a way until the mission pauses
    lifetime: Positive = 5.0  # s a route is followed without being confirmed
    follower: PathFollowerConfig = PathFollowerConfig(acceptance_radius=0.3)
