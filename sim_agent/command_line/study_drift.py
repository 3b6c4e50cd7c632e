"""`weaver study drift`: how far the odometry is off after the paper's waypoint pattern, over several seeds."""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import Any

import numpy as np
from tqdm import tqdm

from robot_agent.evaluation.consistency import band_of_mean
from sim_agent.drift_study import PATTERNS, DriftErrors, DriftRun, walk_pattern
from weaver_shared.errors import InputError


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    worlds = _worlds(options.worlds)
    if options.runs < 1 or options.jobs < 1:
        raise InputError("runs and jobs are whole numbers from 1")
    if options.metres is not None and not 0.5 <= options.metres <= 100.0:
        raise InputError(f"{options.metres} m is no length for the pattern; valid are 0.5 to 100")
    report = {"worlds": {world: _summary(runs) for world, runs in _run(worlds, options).items()}}
    if options.json:
        print(json.dumps(report))
        return 0
    for world, figures in report["worlds"].items():
        low, high = figures["nees_band"]
        alone = figures["without_contacts"]
        print(f"{world:8s} without contacts: drift {alone['drift_percent']:.3f} %, NEES {alone['nees']:.1f}")
        print(
            f"{world:8s} drift {figures['drift_percent']:.3f} % (worst {figures['worst_drift_percent']:.3f}), "
            f"final error {figures['final_error']:.4f} m, ATE {figures['ate_m']:.4f} m, "
            f"NEES {figures['nees']:.1f} (95 % band {low:.1f} to {high:.1f}), "
            f"{figures['reached']} of {len(figures['runs'])} reached the end"
        )
    return 0


def _run(worlds: list[str], options: argparse.Namespace) -> dict[str, list[DriftRun]]:
    """Every world with every seed, `--jobs` at a time, each in a process of its own."""
    results: dict[str, list[DriftRun]] = {world: [] for world in worlds}
    seeds = range(options.seed, options.seed + options.runs)
    with ProcessPoolExecutor(options.jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
        walks = [pool.submit(walk_pattern, world, seed, options.metres) for world in worlds for seed in seeds]
        for walk in tqdm(as_completed(walks), total=len(walks), unit=" walks", file=sys.stderr):
            run = walk.result()
            tqdm.write(_line(run), file=sys.stderr)
            results[run.world].append(run)
    return {world: sorted(runs, key=lambda run: run.seed) for world, runs in results.items()}


def _line(run: DriftRun) -> str:
    errors = ", ".join(
        f"{name} {of.drift_percent:.3f} % of {of.path_length:.1f} m, ATE {of.ate_m:.4f} m, "
        f"NEES {of.normalised_error:.1f}"
        for name, of in (("drift", run.with_contacts), ("without contacts", run.without_contacts))
    )
    return f"{run.world:8s} seed {run.seed}: {errors}, {run.seconds:.0f} s{run.stuck and f'; stuck: {run.stuck}'}"


def _summary(runs: list[DriftRun]) -> dict[str, Any]:
    """Means over the runs with contacts, the same without, and every run."""
    return _means([run.with_contacts for run in runs]) | {
        "reached": sum(not run.stuck for run in runs),
        "nees_band": band_of_mean(len(runs)),
        "without_contacts": _means([run.without_contacts for run in runs]),
        "runs": [run.as_dict() for run in runs],
    }


def _means(errors: list[DriftErrors]) -> dict[str, Any]:
    return {
        "drift_percent": float(np.mean([run.drift_percent for run in errors])),
        "worst_drift_percent": max(run.drift_percent for run in errors),
        "final_error": float(np.mean([run.final_error for run in errors])),
        "ate_m": float(np.mean([run.ate_m for run in errors])),
        "nees": float(np.mean([run.normalised_error for run in errors])),
    }


def _worlds(text: str) -> list[str]:
    worlds = [name.strip() for name in text.split(",")]
    unknown = [name for name in worlds if name not in PATTERNS]
    if unknown:
        raise InputError(f"no pattern for world {', '.join(unknown)}; there is one for {', '.join(PATTERNS)}")
    return worlds


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study drift",
        description="Walk five waypoints in lock step with rendered pictures; errors in m, drift in % of the path.",
    )
    parser.add_argument("--worlds", default="flat,testbed", help="comma-separated (default flat,testbed)")
    parser.add_argument("--runs", type=int, default=5, help="walks a world, each with its own seed (default 5)")
    parser.add_argument("--seed", type=int, default=1, help="of the first walk (default 1)")
    parser.add_argument("--metres", type=float, help="shrink the pattern to this path, m (default: 21.1 and 20.3)")
    parser.add_argument("--jobs", type=int, default=1, help="walks at a time, a core each (default 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
