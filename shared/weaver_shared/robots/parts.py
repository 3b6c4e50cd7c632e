"""What a robot is made of: trunk, servos, joints, legs, camera, IMU and power supply, each with its units."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from weaver_shared.transforms import Pose, rotation_y

Vector3 = tuple[float, float, float]
Positive = Annotated[float, Field(gt=0.0)]

OPTICAL_FROM_FORWARD = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
"""Turns x-forward z-up coordinates into the optical frame: x right, y down, z forward."""


class Part(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Servo(Part):
    """DC servo seen at its output shaft; SI units, rail voltage."""

    torque_constant: Positive
    resistance: Positive
    armature: Positive
    coulomb_friction: Annotated[float, Field(ge=0.0)]
    viscous_friction: Annotated[float, Field(ge=0.0)]
    stall_torque: Positive
    no_load_speed: Positive
    supply_voltage: Positive
    position_gain: Positive
    idle_power: Annotated[float, Field(ge=0.0)]


class Body(Part):
    """The trunk: a box of `size` (m) centred at `box_in_body`."""

    size: Vector3
    box_in_body: Vector3
    mass: Positive
    centre_of_mass_in_body: Vector3


class Joint(Part):
    """One classical Denavit-Hartenberg row (m, rad) with its limits (rad), servo and link mass (kg).

    Legs with more joints than they need, or knees that bend either way, can reach a place in many postures:
    `standing` and `sitting` (rad) are where the search for a posture begins, the middle of the limits if not given;
    `packed` (rad) is the angle in which the leg is folded away for carrying the robot about. `walking` (rad) narrows
    the limits for a robot that walks in one posture and can move itself into another.
    """

    name: str
    servo: str
    theta: float
    d: float
    r: float
    alpha: float
    lower: float
    upper: float
    mass: Positive
    standing: float | None = None
    sitting: float | None = None
    packed: float | None = None
    walking: tuple[float, float] | None = None

    @property
    def walking_limits(self) -> tuple[float, float]:
        """Between which angles the joint stays while the robot walks, rad."""
        return (self.lower, self.upper) if self.walking is None else self.walking

    @model_validator(mode="after")
    def _ordered(self) -> Joint:
        if self.lower >= self.upper:
            raise ValueError(f"joint {self.name}: lower limit {self.lower} rad is not below upper {self.upper} rad")
        least, most = self.walking_limits
        if not self.lower <= least < most <= self.upper:
            raise ValueError(
                f"joint {self.name}: walking {least} to {most} rad is no range within its limits {self.lower} to "
                f"{self.upper} rad"
            )
        for key, angle in (("standing", self.standing), ("sitting", self.sitting), ("packed", self.packed)):
            if angle is not None and not self.lower <= angle <= self.upper:
                raise ValueError(
                    f"joint {self.name}: {key} angle {angle} rad is outside its limits {self.lower} to {self.upper} rad"
                )
        return self


class Posture(Part):
    """Which of its postures a robot is described in, and the description of the same robot in the other one."""

    name: str
    counterpart: str  # name or path of a description


class Leg(Part):
    """Where a leg's chain begins on the body (m, rad) and where its foot stands (m).

    The chain's first axes are the body's, turned by `hip_yaw` about z and then by `hip_roll` about their own x. A
    mirrored leg is the mirror image through their x-z plane: the same joint angles are the mirrored posture.
    """

    name: str
    hip_in_body: Vector3
    hip_yaw: float
    hip_roll: float = 0.0
    mirrored: bool = False
    stance_in_body: tuple[float, float]


class Camera(Part):
    """Rectified stereo pair: identical pinholes (px), `baseline` m apart along the optical x axis."""

    width: Annotated[int, Field(gt=0)]
    height: Annotated[int, Field(gt=0)]
    focal_length: Positive
    baseline: Positive
    position_in_body: Vector3
    pitch_down: float
    rate: Positive

    @property
    def intrinsics(self) -> tuple[float, float, float, float]:
        """fx, fy, cx, cy in pixels; the principal point is the picture's centre."""
        return self.focal_length, self.focal_length, (self.width - 1) / 2, (self.height - 1) / 2

    @property
    def body_from_left(self) -> Pose:
        """Pose of the left eye's optical frame."""
        return self._body_from_eye(0.5 * self.baseline)

    @property
    def body_from_right(self) -> Pose:
        return self._body_from_eye(-0.5 * self.baseline)

    def _body_from_eye(self, left_offset: float) -> Pose:
        rotation = rotation_y(self.pitch_down) @ OPTICAL_FROM_FORWARD.T
        centre = np.asarray(self.position_in_body)
        return Pose(rotation=rotation, position=centre + np.array([0.0, left_offset, 0.0]))


class Imu(Part):
    """IMU axes are parallel to the body's; noise densities as in Kalibr's imu.yaml (SI)."""

    position_in_body: Vector3
    rate: Positive
    gyro_noise_density: Positive
    gyro_random_walk: Positive
    accel_noise_density: Positive
    accel_random_walk: Positive

    @property
    def body_from_imu(self) -> Pose:
        return Pose.of(self.position_in_body)


class Power(Part):
    battery_voltage: Positive
    battery_capacity_ah: Positive
    electronics_power: Annotated[float, Field(ge=0.0)]
    converter_efficiency: Annotated[float, Field(gt=0.0, le=1.0)]
