"""A robot as data: one TOML file from which kinematics, simulation, URDF and pictures are all derived."""

from __future__ import annotations

from functools import cached_property
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field, model_validator

from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots.gaits import Gait, predefined_gaits
from weaver_shared.robots.parts import Body, Camera, Imu, Joint, Leg, Part, Positive, Posture, Power, Servo
from weaver_shared.transforms import rotation_x, rotation_z

__all__ = ["CustomGait", "Imu", "Power", "RobotDescription"]


class CustomGait(Part):
    """A gait of the robot's own: `duty` is stance over stride time, `offsets` the fraction of a stride by leg name.

    A leg lifts when the common phase plus its offset passes a whole number, so greater offsets lift earlier.
    """

    name: str
    duty: Annotated[float, Field(gt=0.0, lt=1.0)]
    offsets: dict[str, Annotated[float, Field(ge=0.0, lt=1.0)]]


class RobotDescription(Part):
    """A legged robot: 3 to 8 legs with the same chain of 3 to 6 joints. Units are SI; frames as in `frames`.

    `gaits` are names of predefined gaits for that many legs or of the robot's own; the first is the one to begin with.
    `locomotion` and `adaptation` hold what differs from Weaver's settings, which a robot of another size must restate.
    """

    model_config = ConfigDict(serialize_by_alias=True)

    name: str
    mass: Positive
    clearance: Positive
    foot_radius: Positive
    sitting_gap: Annotated[float, Field(ge=0.0)] = 0.0
    sitting_spread: Annotated[float, Field(ge=0.0)] = 0.0  # m, feet farther out from the hips than when standing
    gaits: Annotated[tuple[str, ...], Field(min_length=1)]
    custom_gaits: tuple[CustomGait, ...] = ()
    posture: Posture | None = None
    body: Body
    servos: dict[str, Servo]
    joints: Annotated[tuple[Joint, ...], Field(min_length=3, max_length=6)]
    legs: Annotated[tuple[Leg, ...], Field(min_length=3, max_length=8)]
    stereo: Camera | None = Field(default=None, alias="camera")
    imu: Imu
    power: Power
    locomotion: LocomotionConfig = LocomotionConfig()
    adaptation: AdaptationConfig = AdaptationConfig()
    openshc: dict[str, Any] = Field(default_factory=dict)  # what an imported robot was imported from

    @model_validator(mode="after")
    def _consistent(self) -> RobotDescription:
        for joint in self.joints:
            if joint.servo not in self.servos:
                known = ", ".join(sorted(self.servos))
                raise ValueError(f"joint {joint.name}: servo {joint.servo!r} is not described; described are {known}")
        _unique("joints", [joint.name for joint in self.joints])
        _unique("legs", [leg.name for leg in self.legs])
        parts = self.body.mass + len(self.legs) * sum(joint.mass for joint in self.joints)
        if abs(parts - self.mass) > 0.02 * self.mass:
            raise ValueError(f"mass: parts add up to {parts:.2f} kg, but the robot is given as {self.mass:.2f} kg")
        self._check_gaits()
        return self

    def _check_gaits(self) -> None:
        _unique("custom_gaits", [gait.name for gait in self.custom_gaits])
        for gait in self.custom_gaits:
            if set(gait.offsets) != set(self.leg_names):
                found, legs = ", ".join(sorted(gait.offsets)), ", ".join(self.leg_names)
                raise ValueError(f"custom_gaits.{gait.name}.offsets: has {found}; give one for each of the legs {legs}")
        known = predefined_gaits(self.leg_count).keys() | {gait.name for gait in self.custom_gaits}
        for index, name in enumerate(self.gaits):
            if name not in known:
                raise ValueError(
                    f"gaits.{index}: {name!r} is no gait of a robot with {self.leg_count} legs; valid are "
                    f"{', '.join(sorted(known))}"
                )

    @property
    def has_camera(self) -> bool:
        return self.stereo is not None

    @property
    def camera(self) -> Camera:
        """The stereo pair. Raises ConfigurationError for a robot without one."""
        if self.stereo is None:
            raise ConfigurationError(f"robot {self.name!r} has no camera, and what is asked for needs one")
        return self.stereo

    @cached_property
    def gait_table(self) -> dict[str, Gait]:
        """The robot's gaits by name; its own take the place of predefined ones."""
        table = predefined_gaits(self.leg_count)
        for own in self.custom_gaits:
            offset = tuple(own.offsets[name] for name in self.leg_names)
            table[own.name] = Gait(name=own.name, duty=own.duty, offset=offset)
        return {name: table[name] for name in self.gaits}

    def gait(self, name: str) -> Gait:
        """Raises ConfigurationError that names the robot's gaits."""
        if name not in self.gait_table:
            raise ConfigurationError(f"gait {name!r} is unknown; known are {', '.join(self.gait_table)}")
        return self.gait_table[name]

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
    def walking_limits(self) -> NDArray[np.float64]:
        """What of `joint_limits` the posture uses for walking, (joints_per_leg, 2) rad."""
        return np.array([j.walking_limits for j in self.joints])

    @cached_property
    def standing_search(self) -> NDArray[np.float64]:
        """Where the search for standing joint angles begins, (legs, joints) in rad."""
        middle = self.walking_limits.mean(axis=1)
        return np.tile(
            [m if j.standing is None else j.standing for j, m in zip(self.joints, middle, strict=True)],
            (self.leg_count, 1),
        )

    @cached_property
    def sitting_search(self) -> NDArray[np.float64]:
        """Where the search for sitting joint angles begins, (legs, joints) in rad."""
        standing = self.standing_search[0]
        sitting = [s if j.sitting is None else j.sitting for j, s in zip(self.joints, standing, strict=True)]
        return np.tile(sitting, (self.leg_count, 1))

    @cached_property
    def packed_joints(self) -> NDArray[np.float64] | None:
        """Joint angles with all legs folded away, (legs, joints) in rad; None for a robot that is not packed."""
        packed = [joint.packed for joint in self.joints if joint.packed is not None]
        return np.tile(packed, (self.leg_count, 1)) if len(packed) == len(self.joints) else None

    @property
    def belly(self) -> float:
        """Height of the trunk's underside in body (m)."""
        return self.body.box_in_body[2] - 0.5 * self.body.size[2]

    @cached_property
    def sitting_in_body(self) -> NDArray[np.float64]:
        """Foot centres when sitting, (legs, 3): `sitting_spread` outside of their stance, away from the hips, and the
        belly `sitting_gap` over the ground."""
        feet = self.stance_in_body.copy()
        outwards = feet[:, :2] - self.hips_in_body[:, :2]
        feet[:, :2] += self.sitting_spread * outwards / np.linalg.norm(outwards, axis=1, keepdims=True)
        feet[:, 2] = self.belly - self.sitting_gap + self.foot_radius
        return feet

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

    @property
    def half_width(self) -> float:
        """How far beside a straight way its feet are set, m."""
        return float(np.abs(self.stance_in_body[:, 1]).max()) + self.foot_radius

    @property
    def foot_circle(self) -> float:
        """Radius of the circle about its middle that holds its standing feet, however it turns, m."""
        return float(np.hypot(*self.stance_in_body[:, :2].T).max()) + self.foot_radius


def _unique(key: str, names: list[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{key}: the name {name!r} stands for more than one")
