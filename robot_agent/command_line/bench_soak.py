"""`weaver bench soak`: random readings and orders over all robots and gaits; nothing may raise or leave its limits."""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import asdict

from tqdm import tqdm

from robot_agent.locomotion.soak import soak


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="weaver bench soak",
        description="Walk shipped and random robots (3-8 legs of 3-6 joints) on random commands, parameters, contacts "
        "and readings, some of them not numbers, and check every tick: no exception, finite answers, joint positions "
        "and speeds within limits. Exit code 1 if anything was violated.",
    )
    parser.add_argument("--ticks", type=int, default=1_000_000, help="control ticks in all")
    parser.add_argument("--seed", type=int, default=1, help="of all randomness")
    parser.add_argument("--first", type=int, default=0, help="number of the first life, to see a violation again")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    started = time.monotonic()
    with tqdm(total=options.ticks, unit="tick", file=sys.stderr, disable=None) as bar:

        def advance(done: int, violations: int) -> None:
            bar.set_postfix(violations=violations, refresh=False)
            bar.update(min(done, options.ticks) - bar.n)

        result = soak(options.ticks, seed=options.seed, first=options.first, progress=advance)
    if options.json:
        print(json.dumps({"soak": asdict(result) | {"seed": options.seed, "seconds": time.monotonic() - started}}))
    else:
        print(f"{result.ticks} ticks in {result.lives} lives, {len(result.violations)} violations")
        for violation in result.violations:
            print(f"  life {violation.life} ({violation.robot}), tick {violation.tick}: {violation.what}")
    return 1 if result.violations else 0
