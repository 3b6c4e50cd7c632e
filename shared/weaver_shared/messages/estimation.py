"""What the robot concludes about itself and the ground."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


class OdometryQuality(StrEnum):
    INITIALISING = "initialising"
    GOOD = "good"
    DEGRADED = "degraded"
    LOST = "lost"


@dataclass(frozen=True, slots=True, kw_only=True)
class OdometryEstimate:
    """Pose of the body in the world at a frame's stamp (ICRA'17 III-A)."""

    stamp_ns: int
    position_in_world: Array  # (3,) m
    wxyz: Array  # (4,) world_from_body
    velocity_in_world: Array  # (3,) m/s
    angular_velocity_in_body: Array  # (3,) rad/s
    gyro_bias: Array  # (3,) rad/s
    accel_bias: Array  # (3,) m/s^2
    covariance: Array  # (6, 6) of rotation error (body, rad) then position error (world, m)
    quality: OdometryQuality
    reason: str  # why it is not good; empty when it is
    tracked_features: int

    @property
    def world_from_body(self) -> Pose:
        return Pose.of(self.position_in_world, self.wxyz)

    @staticmethod
    def at_rest(
        world_from_body: Pose, stamp_ns: int = 0, quality: OdometryQuality = OdometryQuality.GOOD
    ) -> "OdometryEstimate":
        """A body known to a millimetre to stand there: for pictures whose place was chosen, not estimated."""
        return OdometryEstimate(
            stamp_ns=stamp_ns,
            position_in_world=world_from_body.position,
            wxyz=world_from_body.wxyz,
            velocity_in_world=np.zeros(3),
            angular_velocity_in_body=np.zeros(3),
            gyro_bias=np.zeros(3),
            accel_bias=np.zeros(3),
            covariance=np.eye(6) * 1e-6,
            quality=quality,
            reason="",
            tracked_features=100,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackedFeatures:
    """Where the odometry followed features in one picture, in px of it from its upper left corner; for people."""

    stamp_ns: int  # of the picture
    width: int  # px of the picture
    height: int
    both_eyes: NDArray[np.int16]  # (n, 2) x, y; found in the other eye's picture too
    one_eye: NDArray[np.int16]  # (m, 2)
    rejected: NDArray[np.int16]  # (k, 2) found again, but not where the ground can have moved to


@dataclass(frozen=True, slots=True, kw_only=True)
class TerrainEstimate:
    """Roughness and step height of the patch ahead (ICRA'17 eqs. 7, 8), both 0..1; NaN where unknown."""

    stamp_ns: int
    roughness: float
    roughness_sigma: float
    step_height: float
    step_height_sigma: float
    features: Array  # (7,) f1..f7
    plane_normal_in_world: Array  # (3,)
    health: float  # 0..1, how far the pictures can be trusted
    reason: str
    mode: str = ""  # of the perception that found it: "robust" or "paper"


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitParameters:
    """What the adaptation asks of the gait (ICRA'17 eqs. 9-11)."""

    stamp_ns: int
    virtual_stiffness: float  # N/m
    stride_frequency: float  # Hz
    stride_height: float  # m
    confidence: float  # 0..1


@dataclass(frozen=True, slots=True, kw_only=True)
class AdaptationReport:
    """Why the gait parameters are what they are."""

    stamp_ns: int
    roughness: float  # worst in the circle under the body, 0..1; NaN unknown
    roughness_sigma: float
    step_height: float
    step_height_sigma: float
    ahead_roughness: float  # of the patch ahead
    ahead_step_height: float
    source: str  # who knows the ground: "vision", "feet", "none"
    desired: GaitParameters  # from the polynomials
    applied: GaitParameters  # after overrides and rate limits
    overridden: tuple[str, ...]  # names of GaitParameters fields an operator holds
    preset: str = ""  # by which an operator changes the adaptation; empty before the walk loop has filled it in
    perception: str = ""  # mode of the perception whose ground this is: "robust", "paper"; empty while none is heard


@dataclass(frozen=True, slots=True, kw_only=True)
class MapTile:
    """A square of the terrain map, `size` x `size` cells; row index runs along x, column along y.

    Cell (r, c) of tile (i, j) is centred at ((i * size + r + 0.5) * cell, (j * size + c + 0.5) * cell) in world.
    """

    stamp_ns: int
    i: int
    j: int
    size: int
    cell: float  # m
    elevation_mm: NDArray[np.int16]  # (size, size), -32768 unknown
    sigma_mm: NDArray[np.uint8]  # (size, size) standard deviation, 255 unknown
    roughness: NDArray[np.uint8]  # (size, size), 0..200 for 0..1, 255 unknown
    step_height: NDArray[np.uint8]  # (size, size), 0..200 for 0..1, 255 unknown
    age_s: NDArray[np.uint8]  # (size, size) seconds since last seen, 254 and more, 255 never


@dataclass(frozen=True, slots=True, kw_only=True)
class Waypoint:
    """A place to go to, in world (m)."""

    x: float
    y: float


@dataclass(frozen=True, slots=True, kw_only=True)
class NavigationGoal:
    """Where the robot is to find its own way to; sent by the walk loop while such a mission is active."""

    stamp_ns: int
    serial: int  # of the mission
    active: bool
    place: Waypoint


@dataclass(frozen=True, slots=True, kw_only=True)
class RoutePlan:
    """The way to a goal as the map is known now, or why there is none."""

    stamp_ns: int
    serial: int  # of the mission it was planned for
    goal: Waypoint
    revision: int  # rises when the waypoints are others than before
    found: bool
    reason: str  # why there is no way; empty when there is one
    waypoints: tuple[Waypoint, ...]  # still to be passed, the goal last
    length: float  # m; NaN without a way
