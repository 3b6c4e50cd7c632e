"""`weaver study fit`: the adaptation's polynomials found anew from simulated walks over grounds of known roughness."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path

from tqdm import tqdm

from sim_agent.fit_study.best import BestGait, best_gait
from sim_agent.fit_study.fragment import write_fragment
from sim_agent.fit_study.grounds import Ground, true_indices
from sim_agent.fit_study.least_squares import adapted, fit
from sim_agent.fit_study.plan import Trial, grounds_named, trials, widened
from sim_agent.fit_study.plots import draw_all
from sim_agent.fit_study.refinement import ROUNDS, refined
from sim_agent.fit_study.report import best_table, polynomial_table, write_report
from sim_agent.fit_study.store import TrialStore
from sim_agent.fit_study.trial import TrialResult, walk_trial
from sim_agent.json_figures import without_nan
from sim_agent.report_pages import in_columns
from sim_agent.testbed_study.cluster import walk_all
from weaver_shared.errors import InputError
from weaver_shared.robots import RobotDescription, load_robot

FULL_SEEDS, QUICK_SEEDS = 2, 1


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    count = options.seeds if options.seeds is not None else (QUICK_SEEDS if options.quick else FULL_SEEDS)
    if options.jobs < 1 or count < 1:
        raise InputError("--seeds and --jobs are whole numbers from 1")
    robot, seeds = load_robot(options.robot), range(options.seed, options.seed + count)
    grounds = grounds_named(options.grounds, quick=options.quick)
    swept = widened(robot)
    planned = trials(options.robot, swept, grounds, seeds, quick=options.quick)
    store = TrialStore(Path(options.out))
    results = _results(planned, options, store)
    bests = [_best(ground, robot, results) for ground in grounds]
    for _ in range(ROUNDS):
        closer = [trial for best in bests for trial in refined(best.lowest, _trials_on(best.ground, results))]
        results += _results(closer, options, store)
        bests = [_best(ground, robot, results) for ground in grounds]
    if not any(best.passed for best in bests):
        raise InputError("no gait came over any of these grounds; there is nothing to fit")
    fitted = fit(bests, swept)
    settings = (robot.adaptation, adapted(swept, fitted))
    fragment = store.folder / "adaptation.toml"
    write_fragment(fragment, settings[1], options.robot)
    pictures = draw_all(bests, results, *settings, store.folder)
    written = [fragment, *write_report(store.folder, bests, fitted, settings, pictures)]
    if options.json:
        report = {
            "trials": len(results),
            "grounds": [asdict(best) for best in bests],
            "polynomials": [asdict(one) for one in fitted],
            "written": [str(path) for path in written],
        }
        print(json.dumps(without_nan(report), allow_nan=False))
        return 0
    for table in (best_table(bests), polynomial_table(fitted, robot.adaptation)):
        print(in_columns(table), end="\n\n")
    print("written:", ", ".join(str(path) for path in written))
    return 0


def _results(planned: list[Trial], options: argparse.Namespace, store: TrialStore) -> list[TrialResult]:
    """Every trial's result: those of earlier runs from the store, the others walked now."""
    found = {trial.name: result for trial in planned if (result := store.load(trial)) is not None}
    missing = [trial for trial in planned if trial.name not in found]
    with tqdm(total=len(planned), initial=len(found), unit=" trials", file=sys.stderr) as bar:
        for result in walk_all(missing, walk_trial, options.jobs, options.scheduler):
            store.save(result)
            found[result.trial.name] = result
            bar.update()
    return [found[trial.name] for trial in planned]


def _trials_on(ground: str, results: list[TrialResult]) -> list[Trial]:
    return [result.trial for result in results if result.trial.ground == ground]


def _best(ground: Ground, robot: RobotDescription, results: list[TrialResult]) -> BestGait:
    here = [result for result in results if result.trial.ground == ground.name]
    return best_gait(ground.name, true_indices(ground.world(robot)), here)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study fit",
        description="Walk grounds of known roughness and step height with many virtual stiffnesses (N/m), stride "
        "frequencies (Hz) and stride heights (m), take the best by cost of transport, sway and success, and fit the "
        "adaptation's polynomials (ICRA'17 eqs. 9-11). Finished trials are kept and not walked again.",
    )
    parser.add_argument("--quick", action="store_true", help="five grounds, about 170 trials: half an hour on 2 cores")
    parser.add_argument("--grounds", default="", help="comma-separated names (default: all, or the quick form's)")
    parser.add_argument("--robot", default="weaver", help="a shipped robot or a TOML file")
    parser.add_argument("--seeds", type=int, help="walks of every set on every ground (default 2, quick 1)")
    parser.add_argument("--seed", type=int, default=1, help="the first one, of start and sensors (default 1)")
    parser.add_argument("--out", default="fit_study", help="folder of trials and report (default fit_study)")
    parser.add_argument("--jobs", type=int, default=1, help="trials at a time here, a core each (default 1)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="a Dask scheduler, tcp://host:port, instead of --jobs")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
