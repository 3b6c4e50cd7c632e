"""`weaver terrain FILE`: plane, features, roughness and step height of a cloud, a grid or a stereo pair."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path

from robot_agent.perception.stereo_cloud import read_pair, stereo_cloud
from robot_agent.perception.terrain_files import Cloud, load_terrain
from robot_agent.perception.terrain_report import TerrainReport, report_on_cloud, report_on_grid
from robot_agent.vision.camchain import read_camchain
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.errors import InputError


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if not (math.isfinite(options.scale) and options.scale > 0.0):
        raise InputError(f"--scale {options.scale} is not a positive factor")
    config = PerceptionConfig()
    features = config.features
    terrain = (
        _pair(options, config)
        if options.right or options.calibration
        else load_terrain(Path(options.file), options.scale)
    )
    if isinstance(terrain, Cloud):
        report = report_on_cloud(terrain, options.mode, features)
    else:
        report = report_on_grid(terrain, options.mode, features)
    print(json.dumps(as_json(report), allow_nan=False) if options.json else as_text(report))
    return 0


def _pair(options: argparse.Namespace, config: PerceptionConfig) -> Cloud:
    if not (options.right and options.calibration):
        raise InputError("a stereo pair needs the right eye's picture (--right) and its calibration (--calibration)")
    calibration = read_camchain(Path(options.calibration))
    cloud = stereo_cloud(read_pair(Path(options.file), Path(options.right), calibration), calibration, config)
    return Cloud(points=cloud.points * options.scale, labelled_up=None)


def as_json(report: TerrainReport) -> dict[str, object]:
    """Figures in SI units; unknown numbers are null."""
    terrain = report.terrain
    return {
        "kind": report.kind,
        "frame": report.frame,
        "cell": report.cell,
        "coverage": _number(report.coverage),
        "roughness": {"value": _number(terrain.roughness), "sigma": _number(terrain.roughness_sigma)},
        "step_height": {"value": _number(terrain.step_height), "sigma": _number(terrain.step_height_sigma)},
        "features": [_number(value) for value in report.features],
        "plane": {
            "normal_in_input": [float(value) for value in report.normal_in_input],
            "tilt_deg": report.tilt_deg,
            "tilt_reference": report.tilt_reference,
            "rms": report.rms,
        },
        "steps": [round(top.height, 5) for top in report.steps],
        "step_areas": [round(top.area, 5) for top in report.steps],
    }


def as_text(report: TerrainReport) -> str:
    terrain, normal = report.terrain, ", ".join(f"{value:.4f}" for value in report.normal_in_input)
    steps = ", ".join(f"{1000 * top.height:.0f} mm" for top in report.steps) or "none"
    return "\n".join(
        [
            f"{report.kind} in cells of {1000 * report.cell:.0f} mm, {report.coverage:.0%} known",
            f"roughness    {terrain.roughness:.3f} +- {terrain.roughness_sigma:.3f} (0 flat, 1 roughest)",
            f"step height  {terrain.step_height:.3f} +- {terrain.step_height_sigma:.3f} (0 none, 1 highest)",
            f"plane        normal ({normal}), {report.tilt_deg:.2f} degrees to {report.tilt_reference}, "
            f"rms {1000 * report.rms:.1f} mm",
            f"flat tops    {steps} above the ground",
        ]
    )


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver terrain",
        description="Ground plane, features f1..f7, roughness, step height and flat tops of a point cloud, an "
        "elevation grid or a stereo pair.",
        epilog="tilt_deg is the angle in degrees between the plane's normal and the file's labelled up direction; "
        "where there is none, the camera's up axis (-y) for a cloud in the optical frame, and +z otherwise. "
        "normal_in_input points towards the sensor, or up. steps are heights in m of flat places above the ground.",
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
    parser.add_argument("--json", action="store_true", help="print one JSON object; lengths in m, angles in degrees")
    return parser
