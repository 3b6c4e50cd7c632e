"""From a URDF to the tables of a robot description.

A URDF knows neither motors nor how the robot stands: servos are Weaver's stronger one behind other gears, IMU and power
are Weaver's, and the stance is a guess. What is assumed is told in `notes`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.robots.catalogue import load_robot
from weaver_shared.robots.description import RobotDescription
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.robots.gaits import predefined_gaits
from weaver_shared.robots.urdf.alike import Mount, first_mount, foot_of, mount_like
from weaver_shared.robots.urdf.branches import Branch, Tree, Trunk
from weaver_shared.robots.urdf.elements import UrdfJoint, read_urdf
from weaver_shared.robots.urdf.naming import clockwise, names
from weaver_shared.robots.urdf.stance import sitting_gap, standing_guess

Array = NDArray[np.float64]

WEAVERS_LEG = 0.34  # m
SMALLEST_MASS = 1e-3  # kg, of a link that the URDF gives none
LARGEST_DEVIATION = 1e-2
"""Of the leg's length, between a foot here and in the URDF."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JointMeaning:
    """An angle here is `sign` times the URDF's plus `offset` (rad)."""

    name: str
    urdf_name: str
    sign: float
    offset: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportedRobot:
    tables: dict[str, Any]
    joints: tuple[JointMeaning, ...]
    deviation: float  # m, the most that a foot is elsewhere than in the URDF, over random angles
    notes: tuple[str, ...]


def robot_of_urdf(text: bytes, source: str) -> ImportedRobot:
    """Raises InputError that names the element, what was found and what is valid."""
    name, links, joints = read_urdf(text, source)
    branches, trunk = Tree(links, joints).legs()
    legs = clockwise(branches)
    size = legs[0].length
    if not size > 0.0:
        raise InputError(f"the leg at joint {legs[0].joints[0].name!r} has no length; valid are links of some length")
    first = first_mount(legs[0])
    mounts = [mount_like(leg, first, first.limits(legs[0]), size) for leg in legs]
    leg_names, joint_names = names(legs)
    limits = _limits(legs, mounts, joint_names)
    tables = _tables(name, legs, mounts, trunk, limits, leg_names, joint_names)
    robot = RobotDescription.model_validate(tables)
    deviation = _deviation(robot, legs, mounts)
    if deviation > LARGEST_DEVIATION * size:
        raise InputError(
            f"{source}: as Denavit-Hartenberg rows its feet would be up to {1000 * deviation:.1f} mm elsewhere; valid "
            "are joint axes that are parallel to a thousandth of a radian, or clearly not"
        )
    _stand(tables, robot)
    return ImportedRobot(
        tables=tables,
        joints=_meanings(legs, mounts, leg_names, joint_names),
        deviation=deviation,
        notes=_notes(legs, trunk),
    )


def _limits(legs: list[Branch], mounts: list[Mount], joint_names: list[str]) -> Array:
    """What all legs allow, (n, 2) rad."""
    ranges = np.array([mount.limits(leg) for leg, mount in zip(legs, mounts, strict=True)])
    limits = np.stack([ranges[..., 0].max(axis=0), ranges[..., 1].min(axis=0)], axis=1)
    for index, (lower, upper) in enumerate(limits):
        if lower >= upper:
            found = ", ".join(
                f"{leg.joints[index].name!r} {a:.3f} to {b:.3f}"
                for leg, (a, b) in zip(legs, ranges[:, index], strict=True)
            )
            raise InputError(f"joint {joint_names[index]!r}: the legs' limits have nothing in common: {found:.300} rad")
    return limits


def _tables(
    name: str,
    legs: list[Branch],
    mounts: list[Mount],
    trunk: Trunk,
    limits: Array,
    leg_names: list[str],
    joint_names: list[str],
) -> dict[str, Any]:
    """Without a stance: feet stand where they are at the middle of their limits."""
    masses = np.maximum(np.mean([leg.masses for leg in legs], axis=0), SMALLEST_MASS)
    size = legs[0].length
    weaver = load_robot("weaver")
    body = _body(trunk, mounts, size)
    servos, which = _servos(weaver, legs)
    rows = mounts[0].rows
    return {
        "name": "".join(c if c.isalnum() or c in "-_" else "_" for c in name)[:60] or "imported",
        "mass": float(body["mass"] + len(legs) * masses.sum()),
        "clearance": 0.6 * size,
        "foot_radius": float(np.clip(legs[0].foot_radius, 1e-4, 0.2 * size)),
        "gaits": list(predefined_gaits(len(legs))),
        "body": body,
        "servos": servos,
        "joints": [
            {
                "name": joint_names[i],
                "servo": which[i],
                **dict(zip(("theta", "d", "r", "alpha"), map(float, rows[i]), strict=True)),
                "lower": float(limits[i, 0]),
                "upper": float(limits[i, 1]),
                "mass": float(masses[i]),
            }
            for i in range(len(joint_names))
        ],
        "legs": [
            {
                "name": leg_name,
                "hip_in_body": [float(part) for part in mount.position],
                "hip_yaw": mount.yaw,
                "hip_roll": mount.roll,
                "mirrored": mount.mirrored,
                "stance_in_body": [0.0, 0.0],
            }
            for leg_name, mount in zip(leg_names, mounts, strict=True)
        ],
        "imu": weaver.imu.model_dump() | {"position_in_body": [0.0, 0.0, 0.0]},
        "power": weaver.power.model_dump(),
        **_in_proportion(weaver, size / WEAVERS_LEG, float(body["mass"] + len(legs) * masses.sum()) / weaver.mass),
    }


def _body(trunk: Trunk, mounts: list[Mount], size: float) -> dict[str, Any]:
    """The box around the trunk's shapes; without any, one around the hips."""
    corners = trunk.corners
    if not len(corners) or float(np.ptp(corners, axis=0).min()) < 1e-6:
        places = np.array([mount.position for mount in mounts])
        corners = np.array([places.min(axis=0), places.max(axis=0)])
    extent = np.maximum(corners[1] - corners[0], 0.1 * size)
    return {
        "size": [float(side) for side in extent],
        "box_in_body": [float(part) for part in corners.mean(axis=0)],
        "mass": float(max(trunk.mass, SMALLEST_MASS)),
        "centre_of_mass_in_body": [float(part) for part in trunk.centre],
    }


def _servos(weaver: RobotDescription, legs: list[Branch]) -> tuple[dict[str, Any], list[str]]:
    """One servo for every pair of torque and speed, and which a joint has."""
    known: dict[tuple[float, float, float, float], str] = {}
    which = []
    own = weaver.servos["mx106"]
    for column in zip(*(leg.joints for leg in legs), strict=True):
        torque = min((joint.effort for joint in column if joint.effort > 0.0), default=own.stall_torque)
        speed = min((joint.speed for joint in column if joint.speed > 0.0), default=own.no_load_speed)
        key = (torque, speed, _most("friction", column), _most("damping", column))
        known.setdefault(key, f"servo{len(known) + 1}")
        which.append(known[key])
    return {name: _servo(own.model_dump(), *key) for key, name in known.items()}, which


def _most(key: str, joints: tuple[UrdfJoint, ...]) -> float:
    return max(float(getattr(joint, key)) for joint in joints)


def _servo(own: dict[str, float], torque: float, speed: float, friction: float, damping: float) -> dict[str, float]:
    """Weaver's stronger servo with another gear and as many motors as that torque at that speed needs."""
    gear, strength = own["no_load_speed"] / speed, torque / own["stall_torque"]
    return own | {
        "torque_constant": own["torque_constant"] * gear,
        "resistance": own["resistance"] * gear / strength,
        "armature": own["armature"] * gear * strength,
        "coulomb_friction": friction if friction > 0.0 else own["coulomb_friction"] * strength,
        "viscous_friction": damping if damping > 0.0 else own["viscous_friction"] * gear * strength,
        "stall_torque": torque,
        "no_load_speed": speed,
    }


def _in_proportion(weaver: RobotDescription, size: float, mass: float) -> dict[str, Any]:
    """Weaver's settings for legs and a mass so many times its own."""
    walk, adapt, give = weaver.locomotion, weaver.adaptation, weaver.locomotion.admittance
    stiffness = mass / size  # the robot then sinks by the same share of its legs
    heights = adapt.stride_height
    return {
        "locomotion": {
            "largest_stride": walk.largest_stride * size,
            "largest_speed": walk.largest_speed * size,
            "height_bounds": [size * height for height in walk.height_bounds],
            "rise_speed": walk.rise_speed * size,
            "folding_lift": walk.folding_lift * size,
            "sitting_lift": walk.sitting_lift * size,
            "admittance": {
                "virtual_mass": give.virtual_mass * mass,
                "smallest_damping": give.smallest_damping * mass,
                "largest_offset": give.largest_offset * size,
                "largest_force": give.largest_force * mass,
                "stiffness_bounds": [stiffness * bound for bound in give.stiffness_bounds],
            },
        },
        "adaptation": {
            "height_polynomial": [size * factor for factor in adapt.height_polynomial],
            "stiffness_polynomial": [stiffness * factor for factor in adapt.stiffness_polynomial],
            "stride_height": {
                "lower": heights.lower * size,
                "upper": heights.upper * size,
                "rate": heights.rate * size,
            },
            "virtual_stiffness": {
                key: value * stiffness for key, value in adapt.virtual_stiffness.model_dump().items()
            },
        },
    }


def _deviation(robot: RobotDescription, legs: list[Branch], mounts: list[Mount]) -> float:
    """The most that a foot is elsewhere than in the URDF, m."""
    rng, worst = np.random.default_rng(1), 0.0
    (lower, upper), shape = robot.joint_limits.T, (robot.leg_count, robot.joints_per_leg)
    for _ in range(20):
        ours = rng.uniform(lower, upper, size=shape)
        feet = feet_in_body(robot, ours)
        for leg, mount, angles, foot in zip(legs, mounts, ours, feet, strict=True):
            theirs = mount.signs * (angles - mount.offsets)
            worst = max(worst, float(np.linalg.norm(foot - foot_of(leg, theirs))))
    return worst


def _stand(tables: dict[str, Any], robot: RobotDescription) -> None:
    """Write stance, clearance and the angles that go with them into the tables."""
    angles, feet = standing_guess(robot)
    clearance = robot.foot_radius - float(feet[0, 2])
    if clearance <= 0.0:
        raise InputError(
            f"robot {robot.name!r}: its feet stand {-clearance:.3f} m over the origin of its trunk; valid is a trunk "
            "whose origin is above the ground"
        )
    tables["clearance"] = clearance
    for row, angle in zip(tables["joints"], angles, strict=True):
        row["standing"] = float(np.clip(angle, row["lower"], row["upper"]))
    for row, foot in zip(tables["legs"], feet, strict=True):
        row["stance_in_body"] = [float(foot[0]), float(foot[1])]
    tables["sitting_gap"] = sitting_gap(RobotDescription.model_validate(tables))


def _meanings(
    legs: list[Branch], mounts: list[Mount], leg_names: list[str], joint_names: list[str]
) -> tuple[JointMeaning, ...]:
    return tuple(
        JointMeaning(name=f"{leg_name}_{joint_name}", urdf_name=joint.name, sign=float(sign), offset=float(offset))
        for leg, mount, leg_name in zip(legs, mounts, leg_names, strict=True)
        for joint, joint_name, sign, offset in zip(leg.joints, joint_names, mount.signs, mount.offsets, strict=True)
    )


def _notes(legs: list[Branch], trunk: Trunk) -> tuple[str, ...]:
    notes = [
        "assumed: what servos are besides their torque and speed, imu, power; settings in proportion to Weaver's",
        "guessed: how it stands (clearance, stance, standing) and how low it sits (sitting_gap)",
    ]
    if any(joint.effort <= 0.0 or joint.speed <= 0.0 for leg in legs for joint in leg.joints):
        notes.append("assumed: torque or speed of joints whose limit gives none; those of an MX-106")
    if any(leg.masses.min() < SMALLEST_MASS for leg in legs) or trunk.mass < SMALLEST_MASS:
        notes.append(f"assumed: {SMALLEST_MASS:g} kg for links without mass")
    spread = float(np.ptp([leg.masses for leg in legs], axis=0).max())
    if spread > 1e-9:
        notes.append(f"the legs' links differ by up to {spread:.3g} kg; the mean is taken")
    return tuple(notes)
