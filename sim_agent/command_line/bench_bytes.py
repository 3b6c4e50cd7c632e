"""`weaver bench bytes`: how many damaged records the parsers of the robot's serial lines take for good."""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import asdict

from sim_agent.wire_fuzz import FUZZES
from sim_agent.wire_noise import KINDS


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="weaver bench bytes", description=__doc__)
    parser.add_argument("--records", type=int, default=1_000_000, help="damaged records for each line")
    parser.add_argument("--line", choices=FUZZES, action="append", help="only this line (default: all)")
    parser.add_argument(
        "--every-damage", action="store_true", help="damage IMU records in several places too: their sums can not tell"
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    figures = {}
    for line in options.line or FUZZES:
        begin = time.process_time()
        kinds = {"kinds": KINDS} if options.every_damage else {}
        count = FUZZES[line](options.records, options.seed, **kinds)
        elapsed = time.process_time() - begin
        figures[line] = asdict(count) | {"us_per_record": round(elapsed / (count.damaged + count.sound) * 1e6, 1)}
        if not options.json:
            print(
                f"{line}: {count.wrong} of {count.damaged} damaged records believed, "
                f"{count.sound_lost} of {count.sound} sound ones lost, "
                f"{figures[line]['us_per_record']} us CPU each, making them included"
            )
    if options.json:
        print(json.dumps({"bytes": figures, "seed": options.seed}))
    return 0
