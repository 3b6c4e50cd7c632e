"""What a robot tells its operators."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from weaver_shared.messages.estimation import Waypoint

Array = NDArray[np.float64]


class SafetyAction(StrEnum):
    """Ordered by severity; the most severe verdict wins."""

    ALLOW = "allow"
    HOLD = "hold"
    SIT = "sit"
    CUT = "cut"


class Severity(StrEnum):
    INFO = "info"
    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True, slots=True, kw_only=True)
class Presence:
    """Announces a robot to consoles; the payload of its liveliness query and of `state/presence`."""

    robot_id: str
    session: str  # differs for every start of the robot process
    kind: str  # "SIM", "EMULATED BUS" or "REAL"
    robot: str  # description name
    world: str  # simulated world, empty for a real robot
    schema: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Heartbeat:
    stamp_ns: int
    sequence: int
    session: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeState:
    """State machine of the robot: OFF, READY, STAND, WALK, SIT, HOLD, FAULT, ESTOP."""

    stamp_ns: int
    mode: str
    action: SafetyAction
    reasons: tuple[str, ...]  # what holds the robot or keeps it from standing up; each vanishes when fixed
    stopped: bool  # the latched stop
    stop_level: str  # "", "settle" or "cut"
    allowed: tuple[str, ...]  # CommandName values that would be accepted now from the holder


@dataclass(frozen=True, slots=True, kw_only=True)
class LeaseState:
    holder: str  # operator, empty when free
    epoch: int
    seconds_left: float


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionState:
    stamp_ns: int
    phase: str  # "empty", "ready", "active", "paused", "done"
    waypoints: tuple[Waypoint, ...]
    next_waypoint: int  # index of the waypoint being approached
    cross_track_error: float  # m
    distance_left: float  # m
    lookahead_in_world: Array  # (2,) point the follower steers at; NaN when idle


@dataclass(frozen=True, slots=True, kw_only=True)
class ForbiddenAreas:
    """Polygons that no mission is walked into, as the robot holds them, 1 Hz."""

    stamp_ns: int
    areas: tuple[tuple[Waypoint, ...], ...]  # corners of each, in world


@dataclass(frozen=True, slots=True, kw_only=True)
class PerceptionOrder:
    """How the operator wants the ground judged; from the walk loop, which knows who is in control, to vision."""

    stamp_ns: int
    mode: str  # "robust" or "paper"


@dataclass(frozen=True, slots=True, kw_only=True)
class MissionOutlook:
    """What time and energy a mission takes are estimated from, 2 Hz."""

    stamp_ns: int
    start_in_world: Array  # (2,) m where the mission began, to which the robot returns
    speed: float  # m/s along the way, turning and slowing down included
    speed_basis: str  # "measured"; or "gait": the most that stride frequency and stride allow, nothing was walked yet
    measured_over: float  # m of missions, the last ones walked; 0: nothing was measured
    energy_per_metre: float  # J/m of the whole supply, measured likewise; NaN unknown
    cost_of_transport: float  # eq. 12, the same over the robot's weight; NaN unknown


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotState:
    """Body, joints and feet, 50 Hz. Pose is the odometry propagated to now."""

    stamp_ns: int
    position_in_world: Array  # (3,)
    wxyz: Array  # (4,)
    velocity_command: Array  # (3,) vx, vy m/s and turn rad/s asked of the gait after all limits
    velocity_in_body: Array  # (3,) estimated
    joint_position: Array  # (joints,)
    joint_torque: Array  # (joints,)
    foot_in_body: Array  # (legs, 3) measured
    foot_contact: NDArray[np.bool_]  # (legs,)
    foot_force: Array  # (legs,) vertical, N, from joint torques
    stability_margin: float  # m, static; negative outside the support polygon
    roll: float
    pitch: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoStates:
    """How every servo is, 5 Hz; in the order of `RobotDescription.joint_names`."""

    stamp_ns: int
    temperature: Array  # (joints,) degrees Celsius; NaN not measured
    faults: tuple[str, ...]  # of each what is wrong, empty when it is well; none at all from a body that can not tell


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitState:
    stamp_ns: int
    gait: str
    phase: Array  # (legs,) 0..1 of the stride
    swing: NDArray[np.bool_]  # (legs,)
    parameters_frequency: float
    parameters_height: float
    parameters_stiffness: float


@dataclass(frozen=True, slots=True, kw_only=True)
class LocomotionState:
    """How safely the robot stands, and on what, 20 Hz."""

    stamp_ns: int
    posture: str  # "sitting", "rising", "standing", "walking", "lowering", "changing" (the posture of the legs)
    stability: str  # what the margins allow: "good", "warn", "slow" or "refuse"
    stability_margin: float  # m, static: of the mass to the edge of the support polygon; negative outside
    energy_margin: float  # m, height the mass must be lifted to tip over (normalised energy stability margin)
    ground_plane: Array  # (3,) a, b, c of z = a x + b y + c through the measured feet, in body before posing
    ground_residual: float  # m rms of the feet about that plane
    pose_position: Array  # (3,) m of the posed body against its un-posed place
    pose_rpy: Array  # (3,) rad, roll, pitch, yaw of the same
    slipping: NDArray[np.bool_]  # (legs,) feet that slide against the others
    leg_stages: tuple[str, ...]  # of each leg: "supporting", or in hand "lifting", "held", "lowering"
    lift_margins: Array  # (legs,) m of static margin if that leg were lifted; empty while the robot does not stand
    leg_posture: str  # that the legs are in, such as "insectoid"; empty for a robot with one posture only


@dataclass(frozen=True, slots=True, kw_only=True)
class MotionOrders:
    """What the operator asked of body and legs beyond walking, as the robot holds it, 5 Hz."""

    stamp_ns: int
    pose: Array  # (6,) x, y, z (m), roll, pitch, yaw (rad) of the body against its un-posed place
    automatic_posing: bool
    levelling: bool
    in_sequence: bool  # stand up and sit down with legs in alternating groups
    cruise_velocity: Array  # (3,) forward, left (m/s), turn (rad/s); zeros without a cruise
    cruise_seconds_left: float  # s; 0 without a cruise
    held_legs: tuple[str, ...]  # in the operator's hands
    held_tips: Array  # (held, 3) m in body from where each was lifted to


@dataclass(frozen=True, slots=True, kw_only=True)
class PowerState:
    stamp_ns: int
    battery_voltage: float
    battery_fraction: float  # 0..1
    supply_power: float  # W, everything
    motor_power: float  # W, servos
    energy: float  # J since start
    cost_of_transport: float  # eq. 12 over the last seconds, total; NaN at rest


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopTiming:
    name: str  # "walk", "vision", "physics", "render"
    stamp_ns: int
    rate: float  # Hz
    period_error_p99: float  # s
    overruns: int
    cpu_fraction: float  # of one core
    real_time_factor: float  # simulated over wall time; 1 on a real robot


@dataclass(frozen=True, slots=True, kw_only=True)
class Health:
    """What is alive and how well, 2 Hz, one per process."""

    stamp_ns: int
    timings: tuple[LoopTiming, ...]
    odometry_quality: str
    odometry_reason: str
    odometry_age: float  # s since the last estimate
    tracked_features: int
    max_temperature: float  # degrees Celsius


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    stamp_ns: int
    severity: Severity
    source: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class TruthState:
    """Ground truth of a simulated robot: for evaluation and display only."""

    stamp_ns: int
    position_in_world: Array
    wxyz: Array
    velocity_in_world: Array
