"""OpenSHC's parameters as typed data: names, units and meaning are those of its YAML files (facts 3.18)."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

Array = NDArray[np.float64]
Positive = Annotated[float, Field(gt=0.0)]
NotNegative = Annotated[float, Field(ge=0.0)]
Ratio = Annotated[float, Field(ge=0.0, le=1.0)]


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Adjustable(_Model):
    """A parameter that may change while running, between `min` and `max`, by `step` a request."""

    default: float
    min: float
    max: float
    step: float

    @model_validator(mode="after")
    def _within(self) -> Adjustable:
        if not self.min <= self.default <= self.max:
            raise ValueError(f"default {self.default} is not between min {self.min} and max {self.max}")
        return self


class Joint(_Model):
    """rad and rad/s. `packed` has one posture a packing step, the last one the smallest."""

    min: float
    max: float
    offset: float = 0.0
    packed: tuple[float, ...] = Field(default=(0.0,), min_length=1)
    unpacked: float = 0.0
    max_vel: Positive

    @model_validator(mode="after")
    def _ordered(self) -> Joint:
        if self.min > self.max:
            raise ValueError(f"min {self.min} rad is above max {self.max} rad")
        return self


class Link(_Model):
    """A classical Denavit-Hartenberg row: rad, m, m, rad."""

    theta: float
    d: float
    r: float
    alpha: float


class Axes(_Model):
    x: NotNegative
    y: NotNegative
    z: NotNegative


class Angles(_Model):
    roll: NotNegative
    pitch: NotNegative
    yaw: NotNegative


class Gains(_Model):
    p: float
    i: float
    d: float


class Velocity(_Model):
    x: float
    y: float


class StancePosition(_Model):
    """Foot in the walk plane, m."""

    x: float
    y: float


class Leg(_Model):
    """`links[0]` is the fixed base; joint i moves links[i + 1]."""

    name: str
    links: tuple[Link, ...] = Field(min_length=2)
    joints: tuple[Joint, ...] = Field(min_length=1, max_length=6)
    stance: StancePosition

    @property
    def dh(self) -> Array:
        """(n + 1, 4), rows theta, d, r, alpha."""
        return np.array([[link.theta, link.d, link.r, link.alpha] for link in self.links])

    @property
    def limits(self) -> Array:
        return np.array([[joint.min, joint.max] for joint in self.joints])

    @property
    def place(self) -> Array:
        """Where the foot stands, (3,) m in the walk plane."""
        return np.array([self.stance.x, self.stance.y, 0.0])


class Gait(_Model):
    """Parts of a stride, and how often each leg takes the offset."""

    stance_phase: Annotated[int, Field(ge=1)]
    swing_phase: Annotated[int, Field(ge=1)]
    phase_offset: Annotated[int, Field(ge=0)]
    offset_multiplier: dict[str, Annotated[int, Field(ge=0)]]


class AutoPose(_Model):
    """Cyclic posing of a gait: one entry of each list a cycle; phases in parts of `pose_phase_length`."""

    pose_frequency: float
    pose_phase_length: Annotated[int, Field(ge=1)]
    pose_phase_starts: tuple[int, ...]
    pose_phase_ends: tuple[int, ...]
    pose_negation_phase_starts: dict[str, int]
    pose_negation_phase_ends: dict[str, int]
    negation_transition_ratio: dict[str, Ratio] = Field(default_factory=dict)
    x_amplitudes: tuple[float, ...]
    y_amplitudes: tuple[float, ...]
    z_amplitudes: tuple[float, ...]
    gravity_amplitudes: tuple[float, ...]
    roll_amplitudes: tuple[float, ...]
    pitch_amplitudes: tuple[float, ...]
    yaw_amplitudes: tuple[float, ...]

    @model_validator(mode="after")
    def _one_entry_a_cycle(self) -> AutoPose:
        cycles = len(self.pose_phase_starts)
        for key in (key for key in type(self).model_fields if key.endswith(("_amplitudes", "_phase_ends"))):
            value = getattr(self, key)
            if isinstance(value, tuple) and len(value) != cycles:
                raise ValueError(f"{key} has {len(value)} entries; pose_phase_starts has {cycles}")
        return self


class Configuration(_Model):
    """A robot with everything OpenSHC is told about it; SI units."""

    syropod_type: str
    time_delta: Positive
    manual_posing: bool = True
    auto_posing: bool = False
    rough_terrain_mode: bool = False
    admittance_control: bool = False
    inclination_posing: bool = False
    imu_posing: bool = False
    individual_control_interface: bool = True
    combined_control_interface: bool = True

    leg_id: tuple[str, ...] = Field(min_length=3, max_length=8)
    joint_id: tuple[str, ...] = Field(min_length=1, max_length=6)
    link_id: tuple[str, ...]
    legs: tuple[Leg, ...]
    clamp_joint_positions: bool = True
    clamp_joint_velocities: bool = True
    ignore_IK_warnings: bool = False  # noqa: N815 - OpenSHC's own name

    gait_type: str
    body_clearance: Positive
    step_frequency: Adjustable
    swing_height: Adjustable
    swing_width: Adjustable
    step_depth: Adjustable
    stance_span_modifier: Adjustable
    velocity_input_mode: Literal["throttle", "real"] = "throttle"
    body_velocity_scaler: float = 1.0
    force_cruise_velocity: bool = True
    linear_cruise_velocity: Velocity
    angular_cruise_velocity: float
    cruise_control_time_limit: NotNegative = 0.0
    overlapping_walkspaces: bool = False
    force_normal_touchdown: bool = False
    gravity_aligned_tips: bool = False
    touchdown_threshold: NotNegative = 0.9
    liftoff_threshold: NotNegative = 0.1

    auto_pose_type: str = "auto"
    start_up_sequence: bool = False
    time_to_start: Positive
    rotation_pid_gains: Gains
    max_translation: Axes
    max_rotation: Angles
    max_translation_velocity: NotNegative
    max_rotation_velocity: NotNegative
    leg_manipulation_mode: Literal["tip_control", "joint_control"] = "tip_control"

    dynamic_stiffness: bool = True
    use_joint_effort: bool = False
    integrator_step_time: Positive
    virtual_mass: Adjustable
    virtual_stiffness: Adjustable
    virtual_damping_ratio: Adjustable
    force_gain: Adjustable
    load_stiffness_scaler: float
    swing_stiffness_scaler: float

    console_verbosity: str = "info"
    debug_move_to_joint_position: bool = False
    debug_step_to_position: bool = False
    debug_swing_trajectory: bool = False
    debug_stance_trajectory: bool = False
    debug_execute_sequence: bool = False
    debug_workspace_calculations: bool = False
    debug_ik: bool = False
    debug_rviz: bool = True

    gaits: dict[str, Gait] = Field(min_length=1)
    auto_poses: dict[str, AutoPose] = Field(default_factory=dict)

    @field_validator("leg_id", "joint_id")
    @classmethod
    def _each_once(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        if len(set(names)) != len(names):
            raise ValueError(f"names repeat in {', '.join(names)}")
        return names

    @model_validator(mode="after")
    def _consistent(self) -> Configuration:
        if len(self.link_id) != len(self.joint_id) + 1:
            raise ValueError(
                f"link_id has {len(self.link_id)} names; valid is one more than joint_id, {len(self.joint_id) + 1}"
            )
        if self.gait_type not in self.gaits:
            raise ValueError(f"gait_type {self.gait_type!r} is not described; described are {', '.join(self.gaits)}")
        for name, gait in self.gaits.items():
            if name == self.gait_type and (missing := set(self.leg_id) - set(gait.offset_multiplier)):
                raise ValueError(f"{name}: offset_multiplier has nothing for {', '.join(sorted(missing))}")
        return self

    @property
    def joints_per_leg(self) -> int:
        return max(len(leg.joints) for leg in self.legs)

    @property
    def gait(self) -> Gait:
        return self.gaits[self.gait_type]
