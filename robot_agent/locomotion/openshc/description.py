"""An OpenSHC configuration as a robot of ours, and back.

OpenSHC knows neither masses nor servos, so these are assumed in proportion to the legs and said to be so.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.body_pose import BodyPose
from robot_agent.locomotion.openshc.configuration import Configuration, Leg, Link
from robot_agent.locomotion.openshc.leg import Leg as Chain
from robot_agent.locomotion.openshc.mirroring import joint_signs
from robot_agent.locomotion.openshc.reading import configuration_of, sections_of
from robot_agent.locomotion.openshc.start_up import standing_joints
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.robots.gaits import predefined_gaits

Array = NDArray[np.float64]

LEG_LENGTH, MASS = 0.483, 13.4
"""Bullet's (its URDF), m and kg, from which another robot's mass is taken in proportion."""
MX106_LOAD = 10.3 * 0.28
"""kg m: what Weaver carries on legs how long with the servo that is taken here."""
MASS_IN_LEGS = 0.5
QUARTERS = (pi / 2, pi)
ROUNDING = 5e-4
"""OpenSHC writes quarter turns as 1.571 or 1.57, half turns as 3.142."""
SERVO = "assumed"


def description_of(configuration: Configuration, *, mass: float | None = None) -> dict[str, Any]:
    """The tables of a robot description; `mass` in kg.

    Raises ConfigurationError where legs differ in more than being each other's mirror image.
    """
    reference = configuration.legs[0]
    signs = [joint_signs(reference, leg) for leg in configuration.legs]
    reach = sum(abs(link.r) for link in reference.links[1:])
    mass = MASS * (reach / LEG_LENGTH) ** 2 if mass is None else mass
    per_joint = round(MASS_IN_LEGS * mass / len(configuration.legs) / len(reference.joints), 4)
    trunk = round(mass - per_joint * len(configuration.legs) * len(reference.joints), 4)
    weaver = load_robot("weaver")
    return {
        "name": configuration.syropod_type,
        "mass": round(mass, 4),
        "clearance": configuration.body_clearance,
        "foot_radius": round(0.05 * reach, 4),
        **_gaits(configuration),
        "body": _body(configuration, trunk),
        "servos": {SERVO: _servo(weaver, mass * reach / MX106_LOAD)},
        "joints": _joints(configuration, signs, per_joint),
        "legs": [_leg(leg, sign) for leg, sign in zip(configuration.legs, signs, strict=True)],
        "imu": weaver.imu.model_dump() | {"position_in_body": [0.0, 0.0, 0.0]},
        "power": weaver.power.model_dump(),
        "locomotion": {"height_bounds": [configuration.swing_height.min, configuration.swing_height.max]},
        "openshc": sections_of(configuration)["syropod"],
    }


def configuration_from(robot: RobotDescription) -> Configuration:
    """What `robot` was imported from, with stance and clearance as they are now.

    Raises ConfigurationError for a robot that was not imported, for OpenSHC's own settings are not known then.
    """
    if not robot.openshc:
        raise ConfigurationError(f"robot {robot.name!r}: openshc: this table is missing; valid is an imported robot")
    original = configuration_of(robot.openshc)
    if original.leg_id != robot.leg_names:
        raise ConfigurationError(
            f"robot {robot.name!r}: openshc.parameters.leg_id is {', '.join(original.leg_id)}; valid are the robot's "
            f"legs {', '.join(robot.leg_names)}"
        )
    legs = [
        leg.model_copy(
            update={"stance": leg.stance.model_copy(update=dict(zip("xy", own.stance_in_body, strict=True)))}
        )
        for leg, own in zip(original.legs, robot.legs, strict=True)
    ]
    return original.model_copy(update={"legs": tuple(legs), "body_clearance": robot.clearance})


def _gaits(configuration: Configuration) -> dict[str, Any]:
    """By name where we have them too; others with OpenSHC's own timing."""
    known = predefined_gaits(len(configuration.legs))
    names, own = [], []
    for key, gait in configuration.gaits.items():
        if set(gait.offset_multiplier) != set(configuration.leg_id):
            continue
        name = key.removesuffix("_gait")
        names.append(name)
        base = gait.stance_phase + gait.swing_phase
        begin = int(0.5 * gait.stance_phase)
        offsets = {leg: (gait.phase_offset * n - begin) % base / base for leg, n in gait.offset_multiplier.items()}
        if name not in known:
            own.append({"name": name, "duty": gait.stance_phase / base, "offsets": offsets})
    first = configuration.gait_type.removesuffix("_gait")
    return {"gaits": sorted(names, key=lambda name: name != first), "custom_gaits": own}


def _body(configuration: Configuration, mass: float) -> dict[str, Any]:
    """A box between the hips, its underside level with them."""
    hips = np.array([_hip(leg.links[0]) for leg in configuration.legs])
    length, width = 2.0 * np.abs(hips[:, :2]).max(axis=0)
    height = 0.5 * configuration.body_clearance
    return {
        "size": [round(max(float(side), height), 4) for side in (length, width)] + [round(height, 4)],
        "box_in_body": [0.0, 0.0, round(float(hips[:, 2].mean()) + 0.5 * height, 4)],
        "mass": mass,
        "centre_of_mass_in_body": [0.0, 0.0, round(float(hips[:, 2].mean()) + 0.5 * height, 4)],
    }


def _servo(weaver: RobotDescription, gear: float) -> dict[str, float]:
    """Weaver's stronger servo behind another gear: more torque, as much less speed."""
    servo, gear = weaver.servos["mx106"].model_dump(), max(1.5 * gear, 0.2)
    powers = {"torque_constant": 1, "armature": 2, "coulomb_friction": 1, "viscous_friction": 2, "stall_torque": 1}
    scaled = {key: round(servo[key] * gear**power, 6) for key, power in powers.items()}
    return servo | scaled | {"no_load_speed": round(servo["no_load_speed"] / gear, 6)}


def _joints(configuration: Configuration, signs: list[list[int]], mass: float) -> list[dict[str, Any]]:
    """The first leg's chain with limits that all legs keep."""
    first = configuration.legs[0]
    limits = np.array(
        [
            np.sort(leg.limits * np.array(sign)[:, None], axis=1)
            for leg, sign in zip(configuration.legs, signs, strict=True)
        ]
    )
    lower, upper = limits[..., 0].max(axis=0), limits[..., 1].min(axis=0)
    pose = BodyPose(np.array([0.0, 0.0, configuration.body_clearance]))
    standing = standing_joints(configuration, [Chain(first, configuration.time_delta, clamp_rate=False)], pose)[0]
    result = []
    for k, (name, link) in enumerate(zip(configuration.joint_id, first.links[1:], strict=False)):
        values = {key: _whole_turns(getattr(link, key)) for key in ("theta", "alpha")}
        row = {"name": name, "servo": SERVO, **values, "d": link.d, "r": link.r}
        row |= {"lower": float(lower[k]), "upper": float(upper[k]), "mass": mass}
        row["standing"] = round(float(np.clip(standing[k], lower[k], upper[k])), 6)
        result.append(row)
        if lower[k] >= upper[k]:
            raise ConfigurationError(f"{name}: the legs' limits have nothing in common ({lower[k]} to {upper[k]} rad)")
    return result


def _leg(leg: Leg, signs: list[int]) -> dict[str, Any]:
    base = leg.links[0]
    return {
        "name": leg.name,
        "hip_in_body": [float(part) for part in _hip(base)],
        "hip_yaw": _whole_turns(base.theta),
        "hip_roll": _whole_turns(base.alpha),
        "mirrored": -1 in signs,
        "stance_in_body": [leg.stance.x, leg.stance.y],
    }


def _hip(base: Link) -> Array:
    theta = _whole_turns(base.theta)
    return np.array([base.r * cos(theta), base.r * sin(theta), base.d])


def _whole_turns(angle: float) -> float:
    for quarter in QUARTERS:
        if abs(abs(angle) - quarter) < ROUNDING:
            return quarter if angle > 0.0 else -quarter
    return angle
