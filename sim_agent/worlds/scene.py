"""A world as data: the one description behind physics, pictures and true elevation."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sim_agent.worlds.elevation import heightfield_elevation, highest_box
from sim_agent.worlds.materials import MATERIALS, Material

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Plane:
    """Level ground without end at `height` (m)."""

    height: float
    material: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """A fixed block: centre (3,) and half edges (3,) in m, world_from_box rotation (3, 3)."""

    centre: Array
    half: Array
    material: str
    rotation: Array = field(default_factory=lambda: np.eye(3))

    @staticmethod
    def under(*, x: tuple[float, float], y: tuple[float, float], top: float, depth: float, material: str) -> Box:
        """An upright block given by its extent in x and y, the height of its top and how deep it reaches (m)."""
        centre = np.array([(x[0] + x[1]) / 2, (y[0] + y[1]) / 2, top - depth / 2])
        return Box(centre=centre, half=np.array([(x[1] - x[0]) / 2, (y[1] - y[0]) / 2, depth / 2]), material=material)


@dataclass(frozen=True, slots=True, kw_only=True)
class Heightfield:
    """Heights z (nx, ny) in m on a grid of `cell` m whose first node lies at `origin` (x, y).

    Every cell is two triangles, split along the diagonal from node (i + 1, j) to node (i, j + 1) as Bullet does.
    """

    origin: tuple[float, float]
    cell: float
    z: Array
    material: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Segment:
    """A named stretch of a course between two world x (m)."""

    name: str
    begin: float
    end: float


@dataclass(frozen=True, kw_only=True)
class World:
    """Everything fixed around the robot.

    `start` is the body's x, y (m) and yaw (rad) when a run begins; `bounds` (xmin, xmax, ymin, ymax) is where the
    world is meant to be walked. `friction` is a factor on the coefficients of all materials: damp or dusty ground.
    """

    name: str
    seed: int
    start: tuple[float, float, float]
    bounds: tuple[float, float, float, float]
    planes: tuple[Plane, ...]
    boxes: tuple[Box, ...] = ()
    heightfields: tuple[Heightfield, ...] = ()
    segments: tuple[Segment, ...] = ()
    friction: float = 1.0

    @property
    def solids(self) -> tuple[Plane | Box | Heightfield, ...]:
        return (*self.planes, *self.boxes, *self.heightfields)

    @property
    def materials(self) -> tuple[Material, ...]:
        """Materials in use, in the order of the table."""
        used = {solid.material for solid in self.solids}
        return tuple(material for name, material in MATERIALS.items() if name in used)

    def elevation(self, x: ArrayLike, y: ArrayLike) -> Array:
        """True height of the highest surface over (x, y) in m, in the shape of the arguments."""
        xs, ys = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64))
        flat_x, flat_y = np.ascontiguousarray(xs).reshape(-1), np.ascontiguousarray(ys).reshape(-1)
        height = np.full(flat_x.size, max(plane.height for plane in self.planes))
        for ground in self.heightfields:
            heightfield_elevation(flat_x, flat_y, *ground.origin, ground.cell, ground.z, height)
        if self.boxes:
            highest_box(flat_x, flat_y, *self._box_arrays, height)
        return height.reshape(xs.shape)

    def segment_at(self, x: float) -> str | None:
        """Name of the stretch at world x, None outside the course."""
        for segment in self.segments:
            if segment.begin <= x < segment.end:
                return segment.name
        return None

    @cached_property
    def _box_arrays(self) -> tuple[Array, Array, Array]:
        return (
            np.array([box.centre for box in self.boxes]),
            np.array([box.half for box in self.boxes]),
            np.array([box.rotation for box in self.boxes]),
        )
