"""What a URDF says, element by element; errors name the element, what was found there and what is valid."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite
from typing import TypeVar
from xml.etree import ElementTree as Xml
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose, rotation_from_rpy

Array = NDArray[np.float64]
Named = TypeVar("Named", "UrdfLink", "UrdfJoint")

TURNING, SLIDING, FIXED = ("revolute", "continuous"), ("prismatic", "planar"), "fixed"
TYPES = (*TURNING, *SLIDING, FIXED, "floating")
LARGEST = 1e6
"""Of any number: beyond, products of a few would not be finite."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """A shape in its link's frame: `size` (3,) m are the edges of the box around it along its own axes."""

    kind: str  # box, cylinder, capsule, sphere
    link_from_solid: Pose
    size: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class UrdfLink:
    name: str
    mass: float  # kg; 0 without <inertial>
    centre: Array  # (3,) m of mass
    solids: tuple[Solid, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class UrdfJoint:
    name: str
    kind: str
    parent: str
    child: str
    parent_from_joint: Pose
    axis: Array  # (3,) unit, in the joint's frame
    lower: float  # rad
    upper: float
    effort: float  # N m; 0 where not told
    speed: float  # rad/s; 0 where not told
    friction: float  # N m
    damping: float  # N m s/rad


def read_urdf(text: bytes, source: str) -> tuple[str, dict[str, UrdfLink], tuple[UrdfJoint, ...]]:
    """The robot's name, its links by name and its joints; raises InputError."""
    root = _parse(text, source)
    if root.tag != "robot":
        raise InputError(f"{source}: the outermost element is <{root.tag}>; valid is <robot>")
    if any("xacro" in element.tag for element in root.iter()):
        raise InputError(f"{source}: it has xacro elements; run xacro on it first and import what that writes")
    links = _unique("link", [_link(element) for element in root.findall("link")])
    joints = _unique("joint", [_joint(element) for element in root.findall("joint")])
    if not links:
        raise InputError(f"{source}: there is no <link>; valid is a robot with 3 to 8 legs")
    for joint in joints.values():
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in links:
                raise InputError(f"joint {joint.name!r}: its {role} link {name!r:.60} is not described")
    return root.get("name") or "imported", links, tuple(joints.values())


def _parse(text: bytes, source: str) -> Xml.Element:
    """The document, without any document type: entities are refused, whatever they would do."""

    def refuse(*_: object) -> None:
        raise InputError(f"{source}: it has a document type (<!DOCTYPE ...>); valid is a URDF without one")

    watch = expat.ParserCreate()
    watch.StartDoctypeDeclHandler = refuse
    try:
        watch.Parse(text, True)
        return Xml.fromstring(text)
    except (expat.ExpatError, Xml.ParseError, LookupError, ValueError) as error:
        raise InputError(f"{source} is not XML: {error}") from error


def _unique(kind: str, found: Iterable[Named]) -> dict[str, Named]:
    result: dict[str, Named] = {}
    for one in found:
        if one.name in result:
            raise InputError(f"{kind} {one.name!r} is described twice; valid is once")
        result[one.name] = one
    return result


def _link(element: Xml.Element) -> UrdfLink:
    name = _name(element)
    where = f"link {name!r}"
    inertial, mass, centre = element.find("inertial"), 0.0, np.zeros(3)
    if inertial is not None:
        tag = inertial.find("mass")
        mass = _number(tag.get("value") if tag is not None else None, f"{where}: inertial mass", "kg")
        if mass < 0.0:
            raise InputError(f"{where}: inertial mass is {mass:g} kg; valid is 0 or more")
        centre = _pose(inertial, where).position
    solids = []
    for kind in ("collision", "visual"):
        for part in element.findall(kind):
            solids += _solids(part, f"{where}: {kind}")
    return UrdfLink(name=name, mass=mass, centre=centre, solids=tuple(solids))


def _solids(part: Xml.Element, where: str) -> list[Solid]:
    geometry, pose = part.find("geometry"), _pose(part, where)
    result = []
    for shape in geometry if geometry is not None else ():
        if shape.tag == "box":
            size = _vector(shape.get("size"), f"{where}: box size", "m")
        elif shape.tag == "sphere":
            size = np.full(3, 2.0 * _number(shape.get("radius"), f"{where}: sphere radius", "m"))
        elif shape.tag in ("cylinder", "capsule"):
            radius = _number(shape.get("radius"), f"{where}: {shape.tag} radius", "m")
            length = _number(shape.get("length"), f"{where}: {shape.tag} length", "m")
            size = np.array([2.0 * radius, 2.0 * radius, length])
        else:
            continue  # meshes say nothing that we could use
        result.append(Solid(kind=shape.tag, link_from_solid=pose, size=np.abs(size)))
    return result


def _joint(element: Xml.Element) -> UrdfJoint:
    name = _name(element)
    where = f"joint {name!r}"
    kind = element.get("type", "")
    if kind not in TYPES:
        raise InputError(f"{where}: type {kind!r:.40} is unknown; known are {', '.join(TYPES)}")
    if element.find("mimic") is not None:
        raise InputError(f"{where}: it mimics another joint; valid are legs whose joints move on their own")
    lower, upper, effort, speed = _limits(element, where, kind)
    dynamics = element.find("dynamics")
    return UrdfJoint(
        name=name,
        kind=kind,
        parent=_end(element, "parent", where),
        child=_end(element, "child", where),
        parent_from_joint=_pose(element, where),
        axis=_axis(element, where),
        lower=lower,
        upper=upper,
        effort=effort,
        speed=speed,
        friction=abs(_number(dynamics.get("friction", "0"), f"{where}: friction", "N m"))
        if dynamics is not None
        else 0,
        damping=abs(_number(dynamics.get("damping", "0"), f"{where}: damping", "N m s/rad"))
        if dynamics is not None
        else 0,
    )


def _limits(element: Xml.Element, where: str, kind: str) -> tuple[float, float, float, float]:
    """Lower and upper (rad), effort (N m), speed (rad/s)."""
    limit = element.find("limit")
    if limit is None:
        if kind == "revolute":
            raise InputError(f"{where}: it has no <limit>; valid is one with lower, upper, effort and velocity")
        return -np.pi, np.pi, 0.0, 0.0
    effort, speed = (
        abs(_number(limit.get(key, "0"), f"{where}: limit {key}", unit))
        for key, unit in (("effort", "N m"), ("velocity", "rad/s"))
    )
    if kind != "revolute":
        return -np.pi, np.pi, effort, speed
    lower, upper = (_number(limit.get(key, "0"), f"{where}: limit {key}", "rad") for key in ("lower", "upper"))
    if lower >= upper:
        raise InputError(f"{where}: limit lower {lower:g} rad is not below upper {upper:g} rad")
    return lower, upper, effort, speed


def _axis(element: Xml.Element, where: str) -> Array:
    tag = element.find("axis")
    axis = np.array([1.0, 0.0, 0.0]) if tag is None else _vector(tag.get("xyz"), f"{where}: axis xyz", "")
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        raise InputError(f"{where}: axis xyz has no length; valid is a direction such as 0 0 1")
    unit: Array = axis / length
    return unit


def _end(element: Xml.Element, role: str, where: str) -> str:
    tag = element.find(role)
    link = tag.get("link") if tag is not None else None
    if not link:
        raise InputError(f'{where}: it has no {role}; valid is <{role} link="..."/>')
    return link


def _pose(element: Xml.Element, where: str) -> Pose:
    origin = element.find("origin")
    if origin is None:
        return Pose.identity()
    xyz = _vector(origin.get("xyz", "0 0 0"), f"{where}: origin xyz", "m")
    rpy = _vector(origin.get("rpy", "0 0 0"), f"{where}: origin rpy", "rad")
    return Pose(rotation=rotation_from_rpy(*(float(angle) for angle in rpy)), position=xyz)


def _name(element: Xml.Element) -> str:
    name = element.get("name")
    if not name:
        raise InputError(f"a <{element.tag}> has no name; every one needs its own")
    return name


def _vector(text: str | None, where: str, unit: str) -> Array:
    parts = (text or "").split()
    if len(parts) != 3:
        raise InputError(f"{where} is {text!r:.60}; valid are three numbers{f' in {unit}' if unit else ''}")
    return np.array([_number(part, where, unit) for part in parts])


def _number(text: str | None, where: str, unit: str) -> float:
    try:
        value = float(text) if text is not None else float("nan")
    except ValueError:
        value = float("nan")
    if not isfinite(value) or abs(value) > LARGEST:
        raise InputError(f"{where} is {text!r:.60}; valid is a number{f' in {unit}' if unit else ''}")
    return value
