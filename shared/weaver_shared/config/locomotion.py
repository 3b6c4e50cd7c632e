"""Settings of the gait, the legs' impedance and the body posture (ICRA'17 III-C)."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0.0)]
NotNegative = Annotated[float, Field(ge=0.0)]
Fraction = Annotated[float, Field(ge=0.0, le=1.0)]


class AdmittanceConfig(BaseModel):
    """Eq. 6. The stiffness itself comes with the gait parameters."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    virtual_mass: Positive = 2.0  # kg
    damping_ratio: Positive = 1.0
    smallest_damping: Positive = 260.0  # N s/m; servo and ground are ~5 kN/m: less rings with 30 ms of delay
    largest_offset: Positive = 0.08  # m
    largest_force: Positive = 80.0  # N, of the error that is fed in
    force_time: Positive = 0.02  # s, low-pass on the force
    stiffness_bounds: tuple[Positive, Positive] = (200.0, 5000.0)  # N/m
    dead_band: Annotated[float, Field(ge=0.0)] = 0.0  # N of surplus force that moves nothing
    neighbour_stiffness: Annotated[float, Field(ge=1.0)] = 1.0  # times, of a leg whose neighbour is at its apex


class PostureConfig(BaseModel):
    """Body height and attitude over the feet."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    follow_ground: Fraction = 0.6  # 0: level with gravity, 1: parallel to the ground
    attitude_gain: Positive = 2.0  # 1/s
    attitude_rate: Positive = 0.25  # rad/s
    height_gain: Positive = 2.0  # 1/s
    height_rate: Positive = 0.06  # m/s
    shift_fraction: Fraction = 0.9  # of what puts the mass over the middle of the feet
    largest_shift: Positive = 0.06  # m
    shift_rate: Positive = 0.03  # m/s
    plane_time: Positive = 0.25  # s, low-pass on the fitted ground plane
    attitude_dead_band: Positive = 0.004  # rad
    height_dead_band: Positive = 0.001  # m


class FootholdConfig(BaseModel):
    """How a swinging foot finds the ground."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    touchdown_speed: Positive = 0.08  # m/s downwards at the planned end of a swing and while reaching further
    reach_down: Positive = 0.07  # m below the expected ground before the foot gives up
    earliest_contact: Fraction = 0.45  # of the swing, from where on a contact is the ground
    trip_from: Fraction = (
        0.25  # of the swing; a contact from here to `earliest_contact` is something struck, before it the foot leaving
    )
    trip_to: Fraction = 0.8  # of the swing, up to which a foot that has struck something is led around it
    trip_rise: Positive = 0.25  # m/s, upwards along it
    trip_retreat: Positive = 0.008  # m, back from it
    waiting_time: Positive = 1.0  # s the gait waits for a foot without ground before it goes on
    load_time: Positive = 0.08  # s over which a foot takes up or gives off its load
    contact_hold: Positive = 0.03  # s a contact outlasts its last reading
    contact_from_torque: bool = False  # the servos' torques tell of contact; False: the feet's own sensors
    touchdown_force: Positive = 10.0  # N along gravity from which on a foot counts as on the ground
    liftoff_force: Positive = 4.0  # N under which it no longer does
    along_normal: bool = False  # the second half of a swing comes down along the ground's normal
    swing_width: float = 0.0  # m that the middle of a swing lies farther out than its ends; negative: farther in


class StabilityConfig(BaseModel):
    """What the margins of stability lead to: a warning, a slower walk, no walk. All thresholds in m.

    The static margin is the way of the mass to the edge of the support polygon, the energy margin the height it must
    be lifted to tip over. Either alone is enough for a level; to leave it both must have recovered, for a while.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    warn_static: float = 0.015
    warn_energy: float = 0.0010
    slow_static: float = 0.005
    slow_energy: float = 0.0002
    refuse_static: float = -0.010
    refuse_energy: float = -0.0005
    recovery_static: Positive = 0.005  # beyond its threshold before a level is left
    recovery_energy: Positive = 0.0003
    hold_time: Positive = 0.5  # s for which they must have recovered
    dwell_time: Positive = 0.03  # s the margins must be low: one odd reading is no danger
    slow_factor: Fraction = 0.5  # of the wanted velocity, at the level `slow`
    rest_time: Positive = 1.5  # s a body that may not walk has stood before its margins are put right
    lift_static: float = 0.025  # m that must be left before a leg is lifted for manipulation


class LevellingConfig(BaseModel):
    """PID from the body's tilt (rad) to the turn over its feet that undoes it (rad)."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    proportional: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.2  # the legs answer one to one: 1 would ring
    integral: Positive = 1.2  # 1/s
    derivative: Annotated[float, Field(ge=0.0)] = 0.02  # s
    rate_time: Positive = 0.05  # s, low-pass on the tilt's rate
    largest: Positive = 0.25  # rad


class AutomaticPose(BaseModel):
    """How far the body leans from the legs in the air, as if all of one side swung together; m and rad."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    shift: float = 0.0  # away from the swinging feet
    lift: float = 0.0
    roll: float = 0.0  # swinging side up
    pitch: float = 0.0  # swinging end up
    ahead: float = Field(default=0.0, ge=0.0, le=0.5)  # strides for which it begins before a lift, ends after a landing
    always: bool = False  # also unasked, and awaited before the first foot lifts: the others would not carry the robot


class PosingConfig(BaseModel):
    """The body's pose against where walking alone carries it."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    largest_position: tuple[Positive, Positive, Positive] = (0.06, 0.06, 0.05)  # m, x, y, z
    largest_rotation: tuple[Positive, Positive, Positive] = (0.25, 0.25, 0.30)  # rad, roll, pitch, yaw
    position_rate: Positive = 0.06  # m/s
    rotation_rate: Positive = 0.25  # rad/s
    smoothing: tuple[Positive, Positive] = (0.2, 0.1)  # s; acceleration <= 2 v / T1, jerk <= 4 v / (T1 T2)
    fade_time: Positive = 0.5  # s in which the automatic pose comes and goes
    levelling: LevellingConfig = LevellingConfig()
    automatic: dict[str, AutomaticPose] = {
        "tripod": AutomaticPose(lift=0.02, roll=0.10),
        "ripple": AutomaticPose(shift=0.02, roll=0.045, pitch=0.06),
        "amble": AutomaticPose(lift=0.015),
        "wave": AutomaticPose(shift=0.04, roll=0.045, pitch=0.06),
    }


class ManipulationConfig(BaseModel):
    """Legs lifted for handling things while the robot stands on the others."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    most_legs: Annotated[int, Field(ge=1)] = 2
    lift_height: Positive = 0.08  # m
    ground_clearance: Positive = 0.02  # m, of a held foot over the plane of the others
    largest_tip: Positive = 0.15  # m, on each axis, from where the foot was lifted to
    tip_speed: Positive = 0.10  # m/s
    joint_speed: Positive = 0.5  # rad/s


class FootingConfig(BaseModel):
    """What counts as a slip or a stumble."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    slip_distance: Positive = 0.010  # m a standing foot moves against the others
    slip_time: Positive = 0.5  # s in which earlier slip is forgotten
    settle_time: Positive = 0.12  # s after touch-down that a foot may move
    stumble_window: tuple[Positive, Positive] = (0.25, 0.45)  # of the swing; later contacts are early landings


class LocomotionConfig(BaseModel):
    """Everything the walker can be tuned with; distances m, times s."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    admittance: AdmittanceConfig = AdmittanceConfig()
    posture: PostureConfig = PostureConfig()
    foothold: FootholdConfig = FootholdConfig()
    stability: StabilityConfig = StabilityConfig()
    posing: PosingConfig = PosingConfig()
    manipulation: ManipulationConfig = ManipulationConfig()
    footing: FootingConfig = FootingConfig()
    overlapping_walkspaces: bool = False  # a foot may come nearer to another leg's stance than to its own
    last_link_lean: NotNegative = 0.0  # 1/m, tangent of the last link's lean for each m a foot is from its stance
    largest_stride: Positive = 0.20  # paper: 0.35 m/s at 1 Hz
    largest_speed: Positive = 0.35  # m/s (paper)
    stop_time: Positive = 0.4  # s from the largest velocity to zero
    start_time: Positive = 0.8  # s from zero to the largest velocity
    frequency_bounds: tuple[Positive, Positive] = (0.1, 1.5)  # Hz
    height_bounds: tuple[Positive, Positive] = (0.01, 0.16)  # m
    frequency_rate: Positive = 0.5  # Hz/s
    shortest_swing: Positive = 0.28  # s; gaits that swing a small part of their stride are walked at a lower frequency
    height_rate: Positive = 0.1  # m/s, between swings
    stiffness_rate: Positive = 2000.0  # N/m/s
    rise_speed: Positive = 0.06  # m/s, mean, while standing up or sitting down
    soft_start_speed: Positive = 0.6  # rad/s, mean, towards the posture before standing up
    folding_lift: Positive = 0.05  # m, feet off the ground before the legs are folded away, and after
    march_reach: Positive = 0.015  # m from its stance beyond which a foot steps back in a sequence
    sitting_lift: Positive = 0.004  # m, feet higher than the ground when sitting, so that the belly takes the weight
    speed_fraction: Fraction = 0.9  # of the servos' no-load speed
    feel_ground: bool = True  # False: feet touch down where and when planned; for trajectories without physics
    spare_servos: bool = True  # the gait slows down where swinging legs would need more than their servos' speed
    compensate_servos: bool = True  # lead the servos by the sag and lag known from their data
