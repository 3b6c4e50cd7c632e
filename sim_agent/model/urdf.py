"""URDF of a robot, written from its description; nothing about the robot is stated a second time."""

from __future__ import annotations

from xml.etree import ElementTree as Xml

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sim_agent.model.links import Link, leg_links
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import rotation_x, rotation_z, rpy_from_rotation

Array = NDArray[np.float64]


def robot_urdf(robot: RobotDescription) -> str:
    """One floating trunk with a revolute chain per leg; joint and link names are `RobotDescription.joint_names`."""
    root = Xml.Element("robot", name=robot.name)
    _trunk(root, robot)
    links = leg_links(robot)
    for leg in robot.legs:
        parent = "trunk"
        side = -1.0 if leg.mirrored else 1.0
        origin, rotation = np.asarray(leg.hip_in_body), rotation_z(leg.hip_yaw) @ rotation_x(leg.hip_roll)
        for link, joint in zip(links, robot.joints, strict=True):
            name = f"{leg.name}_{joint.name}"
            element = Xml.SubElement(root, "joint", name=name, type="revolute")
            Xml.SubElement(element, "parent", link=parent)
            Xml.SubElement(element, "child", link=f"{name}_link")
            _origin(element, origin, fixed_axis_angles(rotation @ rotation_z(side * joint.theta)))
            Xml.SubElement(element, "axis", xyz="0 0 -1" if leg.mirrored else "0 0 1")
            servo = robot.servos[joint.servo]
            Xml.SubElement(
                element,
                "limit",
                lower=f"{joint.lower}",
                upper=f"{joint.upper}",
                effort=f"{servo.stall_torque}",
                velocity=f"{servo.no_load_speed}",
            )
            _link(root, f"{name}_link", link, robot.foot_radius)
            parent, origin = f"{name}_link", link.end
            rotation = link.next_rotation.T if leg.mirrored else link.next_rotation
    Xml.indent(root)  # Bullet reads lines of limited length
    return Xml.tostring(root, encoding="unicode")


def fixed_axis_angles(rotation: Array) -> Array:
    """Roll, pitch, yaw in rad as URDF wants them, exact also where pitch is a right angle and the split is free."""
    if abs(rotation[2, 0]) < 1.0 - 1e-9:
        return rpy_from_rotation(rotation)
    pitch = -float(np.sign(rotation[2, 0])) * np.pi / 2
    return np.array([0.0, pitch, np.arctan2(-rotation[0, 1], rotation[1, 1])])


def _trunk(root: Xml.Element, robot: RobotDescription) -> None:
    body = robot.body
    size = np.asarray(body.size)
    square = size**2
    trunk = Xml.SubElement(root, "link", name="trunk")
    _inertial(trunk, body.mass, body.centre_of_mass_in_body, body.mass / 12.0 * (square.sum() - square))
    for kind in ("visual", "collision"):
        part = Xml.SubElement(trunk, kind)
        _origin(part, body.box_in_body)
        Xml.SubElement(Xml.SubElement(part, "geometry"), "box", size=_text(size))


def _link(root: Xml.Element, name: str, link: Link, foot_radius: float) -> None:
    element = Xml.SubElement(root, "link", name=name)
    _inertial(element, link.mass, link.end / 2, link.inertia)
    if link.length > 0.0:
        _capsule(element, "visual", link, 0.0, foot_radius)
    if link.collides:
        _capsule(element, "collision", link, link.collision_begin, foot_radius)
    if link.is_foot:
        for kind in ("visual", "collision"):
            foot = Xml.SubElement(element, kind)
            _origin(foot, link.end)
            Xml.SubElement(Xml.SubElement(foot, "geometry"), "sphere", radius=f"{foot_radius}")


def _capsule(element: Xml.Element, kind: str, link: Link, begin: float, foot_radius: float) -> None:
    """A capsule from `begin` of the link's length to its end; on the foot's link it stays inside the sphere."""
    direction = link.end / link.length
    start = begin * link.length
    stop = link.length - (foot_radius if link.is_foot else 0.0)
    part = Xml.SubElement(element, kind)
    pitch = float(np.arctan2(direction[0], direction[2]))  # links lie in their frame's x-z plane
    _origin(part, direction * (start + stop) / 2, (0.0, pitch, 0.0))
    Xml.SubElement(Xml.SubElement(part, "geometry"), "capsule", radius=f"{link.radius}", length=f"{stop - start}")


def _inertial(element: Xml.Element, mass: float, centre: ArrayLike, moments: ArrayLike) -> None:
    ixx, iyy, izz = np.asarray(moments, dtype=np.float64)
    inertial = Xml.SubElement(element, "inertial")
    _origin(inertial, centre)
    Xml.SubElement(inertial, "mass", value=f"{mass}")
    Xml.SubElement(inertial, "inertia", ixx=f"{ixx}", ixy="0", ixz="0", iyy=f"{iyy}", iyz="0", izz=f"{izz}")


def _origin(element: Xml.Element, xyz: ArrayLike, rpy: ArrayLike = (0.0, 0.0, 0.0)) -> None:
    Xml.SubElement(element, "origin", xyz=_text(xyz), rpy=_text(rpy))


def _text(values: ArrayLike) -> str:
    return " ".join(f"{value:.12g}" for value in np.asarray(values, dtype=np.float64))
