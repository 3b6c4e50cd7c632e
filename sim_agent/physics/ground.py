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
        _load_plane(plane, client)
    for name in MATERIALS:
        boxes = [box for box in world.boxes if box.material == name]
        if boxes:
            _load_boxes(boxes, name, client)
    for heightfield in world.heightfields:
        _load_heightfield(heightfield, client)


def _load_plane(plane: Plane, client: int) -> None:
    shape = pybullet.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[0, 0, 1], physicsClientId=client)
    body = pybullet.createMultiBody(0.0, shape, basePosition=[0.0, 0.0, plane.height], physicsClientId=client)
    _set_contact(body, plane.material, client)


def _load_boxes(boxes: list[Box], material: str, client: int) -> None:
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
        body = pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=client)
    _set_contact(body, material, client)


def _load_heightfield(field: Heightfield, client: int) -> None:
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
    body = pybullet.createMultiBody(0.0, shape, basePosition=middle, physicsClientId=client)
    _set_contact(body, field.material, client)


def _set_contact(body: int, name: str, client: int) -> None:
    material = MATERIALS[name]
    pybullet.changeDynamics(
        body,
        -1,
        lateralFriction=material.friction,
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
