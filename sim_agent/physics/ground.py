"""A world's solids as bodies of the physics engine."""

from __future__ import annotations

import tempfile
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np

from sim_agent.model.urdf import fixed_axis_angles
from sim_agent.physics.quiet import quiet
from sim_agent.worlds import MATERIALS, Box, Heightfield, Plane, World

with quiet():
    import pybullet


def load_ground(world: World, client: int) -> None:
    """Create everything fixed, one body per material for boxes: hundreds of them then cost a step no more than one."""
    for plane in world.planes:
        _set_contact(_load_plane(plane, client), plane.material, world.friction, client)
    for name in MATERIALS:
        boxes = [box for box in world.boxes if box.material == name]
        if boxes:
            _set_contact(_load_boxes(boxes, name, client), name, world.friction, client)
    for heightfield in world.heightfields:
        _set_contact(_load_heightfield(heightfield, client), heightfield.material, world.friction, client)


def _load_plane(plane: Plane, client: int) -> int:
    shape = pybullet.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[0, 0, 1], physicsClientId=client)
    return _fixed(shape, [0.0, 0.0, plane.height], client)


def _load_boxes(boxes: list[Box], material: str, client: int) -> int:
    root = Xml.Element("robot", name=material)
    link = Xml.SubElement(root, "link", name="ground")
    for box in boxes:
        part = Xml.SubElement(link, "collision")
        Xml.SubElement(part, "origin", xyz=_text(box.centre), rpy=_text(fixed_axis_angles(box.rotation)))
        Xml.SubElement(Xml.SubElement(part, "geometry"), "box", size=_text(2.0 * box.half))
    Xml.indent(root)  # Bullet reads lines of limited length
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "ground.urdf"
        path.write_text(Xml.tostring(root, encoding="unicode"))
        body: int = pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client)
    return body


def _load_heightfield(field: Heightfield, client: int) -> int:
    rows, columns = field.z.shape
    shape = pybullet.createCollisionShape(
        pybullet.GEOM_HEIGHTFIELD,
        # NOTE: without this flag feet catch on the edges between triangles, even on level ground.
        flags=pybullet.GEOM_CONCAVE_INTERNAL_EDGE,
        meshScale=[field.cell, field.cell, 1.0],
        heightfieldData=field.z.T.ravel().tolist(),
        numHeightfieldRows=rows,
        numHeightfieldColumns=columns,
        physicsClientId=client,
    )
    middle = [
        field.origin[0] + (rows - 1) * field.cell / 2,
        field.origin[1] + (columns - 1) * field.cell / 2,
        float(field.z.min() + field.z.max()) / 2,  # Bullet centres the heights
    ]
    return _fixed(shape, middle, client)


def _fixed(shape: int, position: list[float], client: int) -> int:
    body: int = pybullet.createMultiBody(0.0, shape, basePosition=position, physicsClientId=client)
    return body


def _set_contact(body: int, name: str, friction: float, client: int) -> None:
    material = MATERIALS[name]
    pybullet.changeDynamics(
        body,
        -1,
        lateralFriction=material.friction * friction,
        spinningFriction=0.0,
        rollingFriction=0.0,
        restitution=0.0,
        physicsClientId=client,
    )
    if material.stiffness is not None and material.damping is not None:
        pybullet.changeDynamics(
            body,
            -1,
            contactStiffness=material.stiffness,
            contactDamping=material.damping,
            physicsClientId=client,
        )


def _text(values: np.ndarray) -> str:
    return " ".join(f"{value:.12g}" for value in values)
