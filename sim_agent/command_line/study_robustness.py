"""`weaver study robustness`: darkness, one eye, dropped frames, bare ground, blur and a passer-by in one walk."""

from __future__ import annotations

import argparse
import json

from robot_agent.odometry import warm_up
from sim_agent.drift_study import PATTERNS
from sim_agent.robustness_study import record_walk, suffer
from weaver_shared.errors import InputError


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.world not in PATTERNS:
        raise InputError(f"no pattern for world {options.world}; there is one for {', '.join(PATTERNS)}")
    if not 1.0 <= options.metres <= 20.0:
        raise InputError(f"{options.metres} m is no length for the walk; valid are 1 to 20")
    warm_up()
    outcomes = suffer(record_walk(options.world, options.seed, options.metres), options.seed)
    if options.json:
        print(json.dumps({"world": options.world, "troubles": {o.trouble: o.as_dict() for o in outcomes}}))
        return 0
    for o in outcomes:
        again = "never good again" if o.recovery_seconds is None else f"good after {o.recovery_seconds:.1f} s"
        print(
            f"{o.trouble:15s} {o.seconds:5.1f} s  error {1e3 * o.error_before:5.1f} -> {1e3 * o.error_after:5.1f} mm "
            f"(worst {1e3 * o.error_worst:.1f}), at the end {1e3 * o.error_final:.1f} mm "
            f"(without {1e3 * o.error_final_without:.1f}), {o.worst_quality}, {again}"
        )
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study robustness",
        description="Walk once with rendered pictures, spoil them in six ways and follow each; errors in mm.",
    )
    parser.add_argument("--world", default="flat", help="flat or testbed (default flat)")
    parser.add_argument("--metres", type=float, default=5.0, help="path of the walk, m (default 5)")
    parser.add_argument("--seed", type=int, default=1, help="of world and noise (default 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
