"""`weaver study testbed`: the paper's testbed experiment, adaptive against fixed, with tables, figures and a report."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tqdm import tqdm

from sim_agent.json_figures import without_nan
from sim_agent.report_pages import in_columns
from sim_agent.testbed_study.cluster import walk_all
from sim_agent.testbed_study.figures import StudyFigures, study_figures
from sim_agent.testbed_study.fixed_set import fixed_set
from sim_agent.testbed_study.plan import PlannedWalk, adaptive_walks, fixed_walks
from sim_agent.testbed_study.plots import draw_all
from sim_agent.testbed_study.report import overall_table, segment_table, write_report
from sim_agent.testbed_study.store import RecordStore
from sim_agent.testbed_study.walk import WalkRecord, outcome_of, walk_testbed
from sim_agent.worlds import make_world
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot

WHOLE_COURSE = 8.4  # m, into segment G


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.runs < 1 or options.jobs < 1:
        raise InputError("--runs and --jobs are whole numbers from 1")
    if not 1.0 <= options.distance <= WHOLE_COURSE:
        raise InputError(f"--distance {options.distance} m is not on the course; valid are 1 to {WHOLE_COURSE}")
    store = RecordStore(Path(options.out))
    records = _records(options, store)
    world, robot = make_world("testbed", options.world_seed), load_robot()
    figures = study_figures(records, world, robot.mass)
    pictures = draw_all(records, world, robot, store.folder)
    written = write_report(store.folder, figures, pictures, records, robot.adaptation)
    if options.json:
        print(json.dumps(without_nan(_as_json(figures, records)), allow_nan=False))
        return 0
    for table in (overall_table(figures), segment_table(figures)):
        print(in_columns(table), end="\n\n")
    print("report:", ", ".join(str(path) for path in written))
    return 0


def _records(options: argparse.Namespace, store: RecordStore) -> list[WalkRecord]:
    """Every planned walk's record: those of earlier runs from the store, the others walked now.

    The first adaptive walk tells the constant parameters of the fixed ones, so these come after.
    """
    adaptive = adaptive_walks(options.runs, options.seed, options.world_seed, options.distance)
    with tqdm(total=2 * options.runs, unit=" walks", file=sys.stderr) as bar:
        records = _walked(adaptive, options, store, bar)
        constant = fixed_set(records[0], load_robot().adaptation)
        records += _walked(fixed_walks(adaptive, constant), options, store, bar)
    return records


def _walked(
    walks: list[PlannedWalk], options: argparse.Namespace, store: RecordStore, bar: tqdm[Any]
) -> list[WalkRecord]:
    records = {walk.name: record for walk in walks if (record := store.load(walk)) is not None}
    bar.update(len(records))
    missing = [walk for walk in walks if walk.name not in records]
    for record in walk_all(missing, walk_testbed, options.jobs, options.scheduler):
        store.save(record)
        records[record.plan.name] = record
        bar.update()
    return [records[walk.name] for walk in walks]


def _as_json(figures: StudyFigures, records: list[WalkRecord]) -> dict[str, Any]:
    return {**asdict(figures), "walks": [outcome_of(record) for record in records]}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study testbed",
        description="Walk the testbed's segments A to G with adaptive and with fixed gait parameters, each walk with "
        "its own start, friction and sensor noise. Finished walks are kept and not walked again.",
    )
    parser.add_argument("--runs", type=int, default=15, help="adaptive walks, and as many fixed ones (default 15)")
    parser.add_argument("--seed", type=int, default=1, help="of the first walk (default 1)")
    parser.add_argument("--world-seed", type=int, default=1, help="of the course's blocks (default 1)")
    parser.add_argument(
        "--distance", type=float, default=WHOLE_COURSE, help=f"m along the course (default {WHOLE_COURSE})"
    )
    parser.add_argument("--out", default="testbed_study", help="folder of records and report (default testbed_study)")
    parser.add_argument("--jobs", type=int, default=1, help="walks at a time on this computer, a core each (default 1)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="a Dask scheduler, tcp://host:port, instead of --jobs")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
