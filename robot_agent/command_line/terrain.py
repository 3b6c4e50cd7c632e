"""`weaver terrain FILE`: plane, features, roughness and step height of a cloud, a grid or a stereo pair."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path

import numpy as np

from robot_agent.perception.local_planes import RADIUS, LocalPlanes
from robot_agent.perception.report_wording import as_json, as_text
from robot_agent.perception.stereo_cloud import read_pair, stereo_cloud
from robot_agent.perception.terrain_files import Cloud, ElevationGrid, load_terrain
from robot_agent.perception.terrain_report import report_on_cloud, report_on_grid
from robot_agent.vision.camchain import read_camchain
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.errors import InputError


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    for name, value, what in (("scale", options.scale, "factor"), ("radius", options.radius, "length in m")):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"--{name} {value} is not a positive {what}")
    config = PerceptionConfig()
    features = config.features
    terrain = (
        _pair(options, config)
        if options.right or options.calibration
        else load_terrain(Path(options.file), options.scale)
    )
    if isinstance(terrain, Cloud):
        if options.layers:
            raise InputError("--layers needs an elevation grid; a cloud or a stereo pair has no cells of its own")
        report = report_on_cloud(terrain, options.mode, features)
    else:
        report = report_on_grid(terrain, options.mode, features, options.radius)
        if options.layers:
            _write_layers(Path(options.layers), terrain, report.layers)
    print(json.dumps(as_json(report), allow_nan=False) if options.json else as_text(report))
    return 0


def _pair(options: argparse.Namespace, config: PerceptionConfig) -> Cloud:
    if not (options.right and options.calibration):
        raise InputError("a stereo pair needs the right eye's picture (--right) and its calibration (--calibration)")
    calibration = read_camchain(Path(options.calibration))
    cloud = stereo_cloud(read_pair(Path(options.file), Path(options.right), calibration), calibration, config)
    return Cloud(points=cloud.points * options.scale, labelled_up=None)


def _write_layers(path: Path, grid: ElevationGrid, planes: LocalPlanes | None) -> None:
    if planes is None:
        return
    try:
        with path.open("wb") as stream:
            np.savez_compressed(
                stream, elevation=grid.heights, slope=planes.slope, roughness=planes.roughness, resolution=grid.cell
            )
    except OSError as error:
        raise InputError(f"{path} can not be written: {error}") from error


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver terrain",
        description="Ground plane, features f1..f7, roughness, step height and flat tops of a point cloud, an "
        "elevation grid or a stereo pair.",
        epilog="tilt_deg is the angle in degrees between the plane's normal and the file's labelled up direction; "
        "where there is none, the camera's up axis (-y) for a cloud in the optical frame, and +z otherwise. "
        "normal_in_input points towards the sensor, or up. steps are heights in m of flat places above the ground. "
        "Where a grid's file has layers named as those of ETH's traversability filters, ours are compared with them.",
    )
    parser.add_argument(
        "file",
        metavar="FILE",
        help=".npz with a cloud (xyz) or a grid (elevation and resolution), or the left picture of a stereo pair",
    )
    parser.add_argument("--right", metavar="FILE", help="the right picture of the pair")
    parser.add_argument("--calibration", metavar="FILE", help="the pair's calibration, Kalibr's camchain.yaml (px, m)")
    parser.add_argument(
        "--mode",
        choices=("robust", "paper"),
        default="robust",
        help="robust plane and noise taken off, or the paper's literal chain with least squares (default robust)",
    )
    parser.add_argument("--scale", type=float, default=1.0, help="factor on all lengths, to metres (default 1)")
    parser.add_argument(
        "--radius",
        type=float,
        default=RADIUS,
        help=f"radius in m of the circle whose plane gives a grid's cell its slope and roughness (default {RADIUS})",
    )
    parser.add_argument(
        "--layers", metavar="FILE", help="write a grid's slope (rad) and roughness (m) of every cell to this .npz"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object; lengths in m, angles in degrees")
    return parser
