"""`weaver study pictures`: how bad pictures may become before heights are wrong, and whether the health says so."""

from __future__ import annotations

import argparse
import json
import math
import sys
from dataclasses import asdict
from typing import Any

import numpy as np
from tqdm import tqdm

from sim_agent.spoiled_pictures import SPOILINGS, SpoiledResult, Views
from sim_agent.worlds import make_world
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot

WRONG = 0.03  # m, from which a height misleads a foot


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.views < 1:
        raise InputError("--views is a whole number from 1")
    places = [float(x) for x in np.linspace(0.3, 6.5, options.views)]
    views = Views(load_robot(), make_world(options.world, options.seed), places, options.seed)
    if views.warning:
        print(f"weaver study pictures: {views.warning}", file=sys.stderr)
    todo = [(kind, level) for kind, spoiling in SPOILINGS.items() for level in spoiling.levels]
    results = [views.spoil(kind, level) for kind, level in tqdm(todo, unit=" levels", file=sys.stderr)]
    missed = [result for result in results if result.trusted and result.error > WRONG]
    if options.json:
        report = {"results": [_finite(result) for result in results], "missed": [_finite(result) for result in missed]}
        print(json.dumps(report, allow_nan=False))
        return 0
    for result in results:
        verdict = "MISSED" if result in missed else "trusted" if result.trusted else "refused"
        print(
            f"{result.kind:17s} {result.level:5.2f} {result.unit:20s} health {result.health:.2f}  "
            f"height error {1000 * result.error:6.1f} mm (90 %)  {result.seen:4.0%} seen  {verdict}"
        )
    return 0


def _finite(result: SpoiledResult) -> dict[str, Any]:
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value
        for key, value in asdict(result).items()
    }


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study pictures",
        description="Spoil rendered pairs more and more (motion blur, darkness, fog, one eye, rows out of line) and "
        "tell the height error and the health that perception gives them. Missed: trusted, yet wrong by over 3 cm.",
    )
    parser.add_argument("--world", default="testbed", help="the course that is looked at (default testbed)")
    parser.add_argument("--views", type=int, default=12, help="places along it (default 12)")
    parser.add_argument("--seed", type=int, default=1, help="of the course and the noise (default 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object; errors in m")
    return parser
