"""Terrain from stereo pictures: matching, height grid, ground plane, features (ICRA'17 III-D)."""

from robot_agent.perception.close_look import CloseLook
from robot_agent.perception.disparity_grid import HeightGrid
from robot_agent.perception.features import Roughness
from robot_agent.perception.felt_ground import BodySense, FeltGround
from robot_agent.perception.terrain import PerceivedTerrain, TerrainPerception
from robot_agent.perception.warm_up import warm_up

__all__ = [
    "BodySense",
    "CloseLook",
    "FeltGround",
    "HeightGrid",
    "PerceivedTerrain",
    "Roughness",
    "TerrainPerception",
    "warm_up",
]
