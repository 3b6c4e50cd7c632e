"""A robot as data: one TOML file from which kinematics, simulation, URDF and pictures are all derived."""

from __future__ import annotations

import tomllib
from functools import cached_property
from importlib import resources
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from weaver_shared.errors import ConfigurationError
from weaver_shared.transforms import Pose, rotation_x, rotation_y, rotation_z

Vector3 = tuple[float, float, float]
Positive = Annotated[float, Field(gt=0.0)]

OPTICAL_FROM_FORWARD = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])
"""Turns x-forward z-up coordinates into the optical frame: x right, y down, z forward."""


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Servo(_Model):
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


class Body(_Model):
    """The trunk: a box of `size` (m) centred at `box_in_body`."""

    size: Vector3
    box_in_body: Vector3
    mass: Positive
    centre_of_mass_in_body: Vector3


class Joint(_Model):
    """One classical Denavit-Hartenberg row (m, rad) with its limits (rad), servo and link mass (kg)."""

    name: str
    servo: str
    theta: float
    d: float
    r: float
    alpha: float
    lower: float
    upper: float
    mass: Positive

    @model_validator(mode="after")
    def _ordered(self) -> Joint:
        if self.lower >= self.upper:
            raise ValueError(f"joint {self.name}: lower limit {self.lower} rad is not below upper {self.upper} rad")
        return self


class Leg(_Model):
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


class Camera(_Model):
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


class Imu(_Model):
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


class Power(_Model):
    battery_voltage: Positive
    battery_capacity_ah: Positive
    electronics_power: Annotated[float, Field(ge=0.0)]
    converter_efficiency: Annotated[float, Field(gt=0.0, le=1.0)]


GaitName = Literal["tripod", "ripple", "amble", "wave"]


class RobotDescription(_Model):
    """A legged robot: n legs with the same chain of m joints. Units are SI; frames as in `frames`."""

    name: str
    mass: Positive
    clearance: Positive
    foot_radius: Positive
    gaits: tuple[GaitName, ...]
    body: Body
    servos: dict[str, Servo]
    joints: tuple[Joint, ...]
    legs: tuple[Leg, ...]
    camera: Camera
    imu: Imu
    power: Power

    @model_validator(mode="after")
    def _consistent(self) -> RobotDescription:
        for joint in self.joints:
            if joint.servo not in self.servos:
                known = ", ".join(sorted(self.servos))
                raise ValueError(f"joint {joint.name}: servo {joint.servo!r} is not described; described are {known}")
        parts = self.body.mass + len(self.legs) * sum(joint.mass for joint in self.joints)
        if abs(parts - self.mass) > 0.02 * self.mass:
            raise ValueError(f"mass: parts add up to {parts:.2f} kg, but the robot is given as {self.mass:.2f} kg")
        return self

    @property
    def leg_count(self) -> int:
        return len(self.legs)

    @property
    def joints_per_leg(self) -> int:
        return len(self.joints)

    @property
    def joint_count(self) -> int:
        return self.leg_count * self.joints_per_leg

    @property
    def leg_names(self) -> tuple[str, ...]:
        return tuple(leg.name for leg in self.legs)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Leg by leg, hip first: the order of every joint array in the project."""
        return tuple(f"{leg.name}_{joint.name}" for leg in self.legs for joint in self.joints)

    @cached_property
    def dh(self) -> NDArray[np.float64]:
        """Rows theta, d, r, alpha of the chain, (joints_per_leg, 4)."""
        return np.array([[j.theta, j.d, j.r, j.alpha] for j in self.joints])

    @cached_property
    def joint_limits(self) -> NDArray[np.float64]:
        """Lower and upper limit of a leg's joints in rad, (joints_per_leg, 2)."""
        return np.array([[j.lower, j.upper] for j in self.joints])

    @cached_property
    def hips_in_body(self) -> NDArray[np.float64]:
        """Chain origins, (legs, 3)."""
        return np.array([leg.hip_in_body for leg in self.legs])

    @cached_property
    def hip_yaws(self) -> NDArray[np.float64]:
        return np.array([leg.hip_yaw for leg in self.legs])

    @cached_property
    def hip_axes(self) -> NDArray[np.float64]:
        """Axes a chain begins with as columns, in body, (legs, 3, 3); left-handed where a leg is mirrored."""
        turned = np.array([rotation_z(leg.hip_yaw) @ rotation_x(leg.hip_roll) for leg in self.legs])
        turned[:, :, 1] *= self.sides[:, None]
        return turned

    @cached_property
    def sides(self) -> NDArray[np.float64]:
        """-1 for mirrored legs and 1 for the others, (legs,)."""
        return np.array([-1.0 if leg.mirrored else 1.0 for leg in self.legs])

    @cached_property
    def stance_in_body(self) -> NDArray[np.float64]:
        """Foot centres when standing at nominal clearance, (legs, 3); the sole is `foot_radius` lower."""
        return np.array([[*leg.stance_in_body, -self.clearance + self.foot_radius] for leg in self.legs])


def robot_names() -> tuple[str, ...]:
    folder = resources.files("weaver_shared.robots")
    return tuple(sorted(entry.name[:-5] for entry in folder.iterdir() if entry.name.endswith(".toml")))


def load_robot(name_or_path: str = "weaver") -> RobotDescription:
    """A shipped robot by name, or one's own TOML file by path.

    Raises ConfigurationError that names the key, what was found and what is valid.
    """
    if name_or_path in robot_names():
        text = (resources.files("weaver_shared.robots") / f"{name_or_path}.toml").read_text()
    elif Path(name_or_path).is_file():
        text = Path(name_or_path).read_text()
    else:
        known = ", ".join(robot_names())
        raise ConfigurationError(f"robot {name_or_path!r} is unknown; known are {known}, or give a .toml file")
    try:
        return RobotDescription.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise ConfigurationError(f"robot {name_or_path!r} is not valid TOML: {error}") from error
    except ValidationError as error:
        raise ConfigurationError(f"robot {name_or_path!r}: {_sentence(error)}") from error


def _sentence(error: ValidationError) -> str:
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"]) or "robot"
    return f"{where}: {first['msg']} (found {first['input']!r:.80})"
