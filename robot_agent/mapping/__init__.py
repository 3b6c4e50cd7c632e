"""The terrain map in the world frame and its worst place under the robot (ICRA'17 III-E)."""

from robot_agent.mapping.terrain_map import TerrainMap, WorstTerrain
from robot_agent.mapping.warm_up import warm_up

__all__ = ["TerrainMap", "WorstTerrain", "warm_up"]
