"""`weaver map FILE`: what a saved map holds, and the map as a point cloud, a GeoTIFF or a costmap."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from robot_agent.mapping.files import LAYERS, MapSnapshot, load_map, write_costmap, write_geotiff, write_ply


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    snapshot = load_map(Path(options.file))
    written = []
    if options.ply:
        write_ply(Path(options.ply), snapshot)
        written.append(options.ply)
    if options.geotiff:
        write_geotiff(Path(options.geotiff), snapshot, options.layer)
        written.append(options.geotiff)
    if options.costmap:
        written += [options.costmap, str(write_costmap(Path(options.costmap), snapshot))]
    facts = describe(snapshot)
    if options.json:
        print(json.dumps({**facts, "written": written}, allow_nan=False))
        return 0
    rows, columns = snapshot.shape
    x, y = snapshot.corner
    print(f"{rows} x {columns} cells of {1000 * snapshot.cell:.0f} mm from x {x:.2f} m, y {y:.2f} m")
    for name, layer in facts["layers"].items():
        if layer["cells"]:
            unit = LAYERS[name] or "0..1"
            print(f"{name:18s} {layer['cells']:7d} cells, {layer['lowest']:.4g} to {layer['highest']:.4g} ({unit})")
    for name in written:
        print(f"wrote {name}")
    return 0


def describe(snapshot: MapSnapshot) -> dict[str, Any]:
    """Known cells and range of every layer, in its unit; lengths in m."""
    layers: dict[str, dict[str, float]] = {}
    for name, layer in snapshot.layers.items():
        known = layer[np.isfinite(layer)]
        layers[name] = {"cells": len(known)}
        if len(known):
            layers[name] |= {"lowest": float(known.min()), "highest": float(known.max())}
    x, y = snapshot.corner
    rows, columns = snapshot.shape
    return {"cell": snapshot.cell, "corner": [x, y], "cells": [rows, columns], "layers": layers}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver map",
        description="What a saved terrain map holds, and the map in other formats.",
        epilog="Maps are saved by `weaver walk --map FILE`. Lengths are in metres of the world frame.",
    )
    parser.add_argument("file", metavar="FILE", help="a map, .npz")
    parser.add_argument("--ply", metavar="FILE", help="write the known cells as a coloured point cloud")
    parser.add_argument("--geotiff", metavar="FILE", help="write one layer as a GeoTIFF, float32, unknown is NaN")
    parser.add_argument("--layer", choices=tuple(LAYERS), default="elevation", help="the layer (default elevation)")
    parser.add_argument("--costmap", metavar="FILE", help="write a .png of costs with its .yaml, as Nav2 reads them")
    parser.add_argument("--json", action="store_true", help="print one JSON object; lengths in m")
    return parser
