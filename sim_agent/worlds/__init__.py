"""Worlds a robot can be simulated in, each from a name and a seed."""

from sim_agent.worlds.catalogue import WORLD_NAMES, make_world
from sim_agent.worlds.materials import MATERIALS, Material
from sim_agent.worlds.scene import Box, Heightfield, Plane, Segment, World

__all__ = [
    "MATERIALS",
    "WORLD_NAMES",
    "Box",
    "Heightfield",
    "Material",
    "Plane",
    "Segment",
    "World",
    "make_world",
]
