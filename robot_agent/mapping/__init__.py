"""The terrain map in the world frame and its worst place under the robot (ICRA'17 III-E)."""

from robot_agent.mapping.firm_feet import FirmFeet
from robot_agent.mapping.footholds import Cover
from robot_agent.mapping.footprint import WorstTerrain
from robot_agent.mapping.terrain_map import TerrainMap
from robot_agent.mapping.warm_up import warm_up

__all__ = ["Cover", "FirmFeet", "TerrainMap", "WorstTerrain", "warm_up"]
