"""Finished maps as files: kept and loaded again (NPZ), and for others to read (PLY, GeoTIFF, costmap)."""

from robot_agent.mapping.files.costmap import write_costmap
from robot_agent.mapping.files.geotiff import write_geotiff
from robot_agent.mapping.files.map_file import load_map, save_map
from robot_agent.mapping.files.ply import write_ply
from robot_agent.mapping.files.snapshot import LAYERS, MapSnapshot

__all__ = ["LAYERS", "MapSnapshot", "load_map", "save_map", "write_costmap", "write_geotiff", "write_ply"]
