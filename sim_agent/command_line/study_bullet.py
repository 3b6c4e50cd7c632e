"""`weaver study bullet`: power and cost of transport of Bullet's arrangements and postures, beside the paper's."""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from tqdm import tqdm

from sim_agent.bullet_study import paper
from sim_agent.bullet_study.measure import Measured, measure
from sim_agent.bullet_study.plots import draw_all
from sim_agent.bullet_study.points import Point, points_of
from sim_agent.bullet_study.reasons import reasons
from sim_agent.bullet_study.report import sections, write_report
from sim_agent.bullet_study.store import PointStore
from sim_agent.bullet_study.tables import bipod_faster
from sim_agent.json_figures import without_nan
from sim_agent.report_pages import in_columns
from weaver_shared.errors import InputError

SHORTEST, LONGEST = 0.5, 600.0  # s


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.jobs < 1:
        raise InputError(f"--jobs {options.jobs} is not valid; use a whole number from 1")
    if not SHORTEST <= options.seconds <= LONGEST:
        raise InputError(f"--seconds {options.seconds:g} is not valid; use {SHORTEST:g} to {LONGEST:g} s")
    store = PointStore(Path(options.out))
    measured = _measured(points_of(options.seconds, options.seed, quick=options.quick), store, options.jobs)
    written = write_report(store.folder, measured, draw_all(measured, store.folder))
    if options.json:
        print(json.dumps(_as_json(measured, written), allow_nan=False))
        return 0
    for title, table in sections(measured):
        print(title, in_columns(table), sep="\n", end="\n\n")
    print(*(f"- {text}" for text in reasons(measured)), sep="\n")
    print("report:", ", ".join(str(path) for path in written))
    return 0


def _measured(points: list[Point], store: PointStore, jobs: int) -> list[Measured]:
    """Every point's figures: those of earlier runs from the store, the others measured now."""
    found = {point: one for point in points if (one := store.load(point)) is not None}
    missing = [point for point in points if point not in found]
    with tqdm(total=len(points), initial=len(found), unit=" points", file=sys.stderr) as bar:
        if missing:
            with ProcessPoolExecutor(min(jobs, len(missing)), mp_context=multiprocessing.get_context("spawn")) as pool:
                for done in as_completed([pool.submit(measure, point) for point in missing]):
                    one = done.result()
                    store.save(one)
                    found[one.point] = one
                    bar.update()
    return [found[point] for point in points]


def _as_json(measured: list[Measured], written: list[Path]) -> dict[str, Any]:
    result: dict[str, Any] = without_nan(
        {
            "paper_table_4": [
                {"robot": robot, "gait": gait, "stance_air": row.stance_air, "walk_air": row.walk_air,
                 "stance_ground": row.stance_ground}
                for (robot, gait), row in paper.TABLE_4.items()
            ],
            "bipod_over_tripod_speed": bipod_faster(measured),
            "points": [one.as_dict() for one in measured],
            "reasons": reasons(measured),
            "report": [str(path) for path in written],
        }
    )  # fmt: skip
    return result


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study bullet",
        description="Power (W) standing and walking in the air and on the ground, and cost of transport against step "
        "frequency (Hz), of Bullet in arrangements A and B, insectoid and mammalian, in tripod and bipod gait. "
        "Finished points are kept and not measured again.",
    )
    parser.add_argument("--out", default="bullet_study", help="folder of points and report (default bullet_study)")
    parser.add_argument("--quick", action="store_true", help="fewer step frequencies and no variants of the model")
    parser.add_argument("--seconds", type=float, default=8.0, help="s measured at every point (default 8)")
    parser.add_argument("--seed", type=int, default=1, help="of the simulated sensors (default 1)")
    parser.add_argument("--jobs", type=int, default=1, help="points at a time, a core each (default 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
