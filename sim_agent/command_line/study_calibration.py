"""`weaver study calibration`: how well calibration finds the truth behind rendered recordings of a target."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from robot_agent.vision.camera import Distortion
from sim_agent.board_study import calibrate_boards
from sim_agent.calibration_study import RATE, CalibrationRun, calibrate_rendered
from sim_agent.targets.waved_robot import GRID, record_waved
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot
from weaver_shared.transforms import rotation_log

GOALS = {
    "focal_error_percent": (0.2, "%"),
    "baseline_error_mm": (0.1, "mm"),
    "imu_rotation_error_deg": (0.02, "degrees"),
    "imu_translation_error_mm": (0.3, "mm"),
    "time_offset_error_us": (30.0, "us"),
}
MODELS: dict[str, Distortion] = {"radtan": "radtan", "equidistant": "equidistant"}


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    models = [MODELS[name] for name in options.models.split(",") if name in MODELS]
    if len(models) != len(options.models.split(",")):
        raise InputError(f"--models {options.models} is unknown; valid are {', '.join(MODELS)}")
    if options.runs < (0 if options.boards is not None else 1):
        raise InputError("runs are a whole number from 1, or 0 with --boards")
    if not 5.0 <= options.seconds <= 120.0:
        raise InputError(f"{options.seconds} s is no length for a recording; valid are 5 to 120")
    if options.record is not None:
        return _record(options)
    runs = []
    total = options.runs * round(RATE * options.seconds)
    with tqdm(total=total, unit=" pairs", desc="rendering and detecting", file=sys.stderr) as bar:
        for k in range(options.runs):
            model = models[k % len(models)]
            runs.append(calibrate_rendered(options.seed + k, model, options.seconds, bar.update))
    report = _summary(runs)
    if options.boards is not None:
        boards = calibrate_boards(options.boards)
        report["boards"] = asdict(boards)
        report["goals_met"] = report["goals_met"] and boards.reprojection_px <= 1.05 * boards.opencv_px
    if options.json:
        print(json.dumps(report))
        return 0
    for run in runs:
        print(f"seed {run.seed}, {run.model}, {run.pictures} pairs, corners to {run.corner_sigma_px:.3f} px:")
        for key, (goal, unit) in GOALS.items():
            print(f"  {key.rpartition('_error')[0].replace('_', ' '):16s} {getattr(run, key):.4f} {unit} (goal {goal})")
    if options.boards is not None:
        ours, opencv = boards.reprojection_px, boards.opencv_px
        print(f"{boards.pairs} real pairs: {ours:.4f} px, OpenCV {opencv:.4f} px (goal: at most 5 % more)")
    print("every goal met" if report["goals_met"] else "not every goal met")
    return 0


def _record(options: argparse.Namespace) -> int:
    robot = load_robot(options.robot)
    if not robot.has_camera:
        raise InputError(f"the robot {robot.name!r} has no camera")
    total = round(robot.camera.rate * options.seconds)
    with tqdm(total=total, unit=" pairs", desc="rendering", file=sys.stderr) as bar:
        truth = record_waved(options.record, robot, options.seed, options.seconds, bar.update)
    imu_from_camera = truth.camera_from_imu.inverse()
    report = {
        "recording": str(options.record),
        "target": str(GRID),
        "focal_lengths_px": truth.rig.intrinsics[:, :2].tolist(),
        "baseline_mm": 1e3 * truth.rig.baseline,
        "camera_in_imu_mm": (1e3 * imu_from_camera.position).tolist(),
        "rotation_vector_deg": np.degrees(rotation_log(imu_from_camera.rotation)).tolist(),
        "time_offset_ms": 1e3 * truth.time_offset,
    }
    if options.json:
        print(json.dumps(report))
        return 0
    print(f"{options.record} shows an {GRID}; what is to be found:")
    for key, value in list(report.items())[2:]:
        print(f"  {key.replace('_', ' ')}: {np.array2string(np.asarray(value), precision=4, separator=', ')}")
    return 0


def _summary(runs: list[CalibrationRun]) -> dict[str, Any]:
    worst = {key: max(getattr(run, key) for run in runs) for key in GOALS} if runs else {}
    return {
        "runs": [run.as_dict() for run in runs],
        "worst": worst,
        "goals": {key: goal for key, (goal, _) in GOALS.items()},
        "goals_met": all(worst[key] <= GOALS[key][0] for key in worst),
    }


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study calibration",
        description="Render an AprilGrid waved before a made-up stereo-inertial rig, calibrate, compare with the truth "
        "(errors in %%, mm, degrees, microseconds).",
    )
    parser.add_argument("--runs", type=int, default=4, help="rigs and recordings, each with its own seed (default 4)")
    parser.add_argument("--seed", type=int, default=1, help="of the first run (default 1)")
    parser.add_argument("--seconds", type=float, default=30.0, help="of each recording, s (default 30)")
    parser.add_argument("--models", default="radtan,equidistant", help="lenses in turn (default radtan,equidistant)")
    parser.add_argument(
        "--boards", type=Path, metavar="DIR", help="also compare with OpenCV on real pairs of a 9 x 6 board of 25 mm"
    )
    parser.add_argument(
        "--record",
        type=Path,
        metavar="FILE",
        help="instead write one such recording as of a robot, .mcap: to try weaver calibrate or the page with",
    )
    parser.add_argument("--robot", default="weaver", help="whose recording it is: a shipped name or a TOML file")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
