"""`weaver study terrain`: the map the robot makes on its way, against the ground that was really there."""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import asdict
from typing import Any

import numpy as np
from tqdm import tqdm

from robot_agent.loops import CONTROL_RATE
from sim_agent.lock_step import LockStep
from sim_agent.map_truth import SegmentTruth, compare, rank_correlation
from sim_agent.mission import begin_mission
from sim_agent.worlds import World, make_world
from weaver_shared.config.mapping import MappingConfig
from weaver_shared.errors import InputError
from weaver_shared.messages import Waypoint
from weaver_shared.robots import load_robot

DISTANCES = {"testbed": 8.4, "flat": 3.0, "outdoor": 3.0, "stairs": 2.0}
LAYERS = ("elevation", "roughness", "step_height")
SLOWEST = 0.015  # m/s
LOOK_EVERY = 100  # ticks


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    worlds = [name.strip() for name in options.worlds.split(",")]
    unknown = [name for name in worlds if name not in DISTANCES]
    if unknown:
        raise InputError(f"no walk is planned on {', '.join(unknown)}; there is one on {', '.join(DISTANCES)}")
    if options.runs < 1:
        raise InputError("--runs is a whole number from 1")
    walks = [(name, seed) for name in worlds for seed in range(options.seed, options.seed + options.runs)]
    results: dict[str, list[dict[str, SegmentTruth]]] = {name: [] for name in worlds}
    for name, seed in tqdm(walks, unit=" walks", file=sys.stderr):
        results[name].append(map_errors(make_world(name, seed), seed, options.metres or DISTANCES[name]))
    report = {name: _summary(runs) for name, runs in results.items()}
    if options.json:
        print(json.dumps({"worlds": report}, allow_nan=False))
    else:
        _print(report)
    return 0


def map_errors(world: World, seed: int, metres: float) -> dict[str, SegmentTruth]:
    """Walk along x and compare the map with the truth, each segment when its end is reached.

    Raises InputError when the robot does not get there.
    """
    run = LockStep(load_robot(), world, seed)
    found: dict[str, SegmentTruth] = {}
    ends = {segment.name: segment.end for segment in world.segments}
    try:
        begin_mission(run, (Waypoint(x=metres, y=0.0),))
        for tick in range(round(metres / SLOWEST * CONTROL_RATE)):
            walked = run.step().walk
            phase = run.walk.desk.mission(walked.stamp_ns).phase
            if tick % LOOK_EVERY == 0 or phase != "active":
                x = float(walked.state.world_from_body.position[0])
                passed = [name for name, end in ends.items() if x > end - 0.1 and name not in found]
                if passed or phase == "done":
                    now = _compare(run, world)
                    wanted = set(now) - set(found) if phase == "done" else set(passed) & set(now)
                    found |= {name: now[name] for name in wanted}
            if phase == "done":
                return found
            if phase == "paused":
                break
        raise InputError(f"on {world.name} with seed {seed} the robot did not come {metres} m far")
    finally:
        run.close()


def _compare(run: LockStep, world: World) -> dict[str, SegmentTruth]:
    terrain_map = run.map()
    return compare(terrain_map.snapshot(), world, MappingConfig()) if terrain_map is not None else {}


def _summary(runs: list[dict[str, SegmentTruth]]) -> dict[str, Any]:
    """Means over the runs, by segment and layer, and how well the segments' order was found."""
    names = sorted({name for run in runs for name in run})
    segments = {}
    for name in names:
        held = [asdict(run[name]) for run in runs if name in run]
        segments[name or "all"] = {
            layer: {key: float(np.mean([run[layer][key] for run in held])) for key in held[0][layer]}
            for layer in LAYERS
        }
    ranks = {layer: [rank_correlation(run, layer) for run in runs] for layer in ("roughness", "step_height")}
    return {
        "runs": len(runs),
        "segments": segments,
        "rank_correlation": {
            layer: float(np.mean(values)) if all(map(math.isfinite, values)) else None
            for layer, values in ranks.items()
        },
    }


def _print(report: dict[str, Any]) -> None:
    for world, figures in report.items():
        print(f"{world}, {figures['runs']} walks: mean absolute error, share within two sigma, level (true)")
        for name, layers in figures["segments"].items():
            cells = [
                f"{layer} {1000 * e['mean_absolute_error']:.1f} mm {e['within_two_sigma']:.0%}"
                if layer == "elevation"
                else f"{layer.replace('_', ' ')} {e['mean_absolute_error']:.3f} {e['within_two_sigma']:.0%} "
                f"{e['map_level']:.2f} ({e['true_level']:.2f})"
                for layer, e in layers.items()
            ]
            print(f"  {name:4s} " + "   ".join(cells))
        for layer, rank in figures["rank_correlation"].items():
            if rank is not None:
                print(f"  rank correlation of the segments' {layer.replace('_', ' ')}: {rank:.2f}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study terrain",
        description="Walk with rendered pictures and compare the map's elevation (m), roughness and step height (0..1) "
        "with those of the true surface: error, bias, and how often the stated uncertainty covers it.",
    )
    parser.add_argument("--worlds", default="testbed,flat", help=f"comma-separated, of {', '.join(DISTANCES)}")
    parser.add_argument("--runs", type=int, default=1, help="walks a world, each with its own seed (default 1)")
    parser.add_argument("--seed", type=int, default=1, help="of the first walk (default 1)")
    parser.add_argument("--metres", type=float, help="how far to walk, m (default: the world's course)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
