"""`weaver study robots`: every robot in every gait stands, walks, turns and sits, and some climb, judged by truth."""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from tqdm import tqdm

from sim_agent.study.manoeuvres import WAYS
from sim_agent.study.pictures import GALLERY, take
from sim_agent.study.plan import WORLDS, Course, courses
from sim_agent.study.report import table
from sim_agent.study.result import Result
from sim_agent.study.summary import summary
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot, robot_names


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.jobs < 1 or options.seed < 0:
        raise InputError("--jobs is a whole number from 1, --seed one from 0")
    robots = _chosen(options.robots, robot_names(), "robot") or robot_names()
    known = sorted({gait for name in robots for gait in load_robot(name).gaits})
    gaits = _chosen(options.gaits, known, "gait")
    worlds = _chosen(options.worlds, WORLDS, "world") or WORLDS
    ways = _chosen(options.manoeuvres, WAYS, "manoeuvre") or WAYS
    results = _run(courses(robots, gaits, worlds, options.seed, ways), options.jobs)
    if options.pictures:
        _photograph(robots, Path(options.pictures))
    if options.report:
        Path(options.report).write_text(f"{summary(results)}\n## All figures\n{table(results)}")
    if options.json:
        print(json.dumps({"results": [result.as_dict() for result in results]}))
    elif not options.report:
        print(table(results), end="")
    failed = sum(not result.passed for result in results)
    print(f"{len(results) - failed} of {len(results)} passed", file=sys.stderr)
    return 1 if failed else 0


def _run(planned: list[Course], jobs: int) -> list[Result]:
    """All courses, `jobs` at a time, in the order planned."""
    found: dict[Course, list[Result]] = {}
    with ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn")) as pool:
        walks = {pool.submit(course.walk): course for course in planned}
        for walk in tqdm(as_completed(walks), total=len(walks), unit=" courses", file=sys.stderr):
            found[walks[walk]] = walk.result()
    return [result for course in planned for result in found[course]]


def _photograph(robots: tuple[str, ...], folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    scenes = [scene for scene in GALLERY if scene.robot in robots]
    for scene in tqdm(scenes, unit=" pictures", file=sys.stderr):
        take(scene, folder)


def _chosen(text: str | None, known: tuple[str, ...] | list[str], what: str) -> tuple[str, ...]:
    """The comma-separated names; none for no text. Raises InputError on one that is not known."""
    names = tuple(name.strip() for name in text.split(",")) if text is not None else ()
    for name in names:
        if name not in known:
            raise InputError(f"{what} {name!r} is unknown here; known are {', '.join(known)}")
    return names


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver study robots",
        description="Walk robots in simulation without console, cameras and odometry. Speeds in m/s and rad/s, margins "
        "of stability in mm. Ends with 1 when something failed.",
    )
    parser.add_argument("--robots", help=f"comma-separated (default all: {', '.join(robot_names())})")
    parser.add_argument("--gaits", help="comma-separated (default: all a robot has, on slopes and stairs tripod)")
    parser.add_argument("--worlds", help=f"comma-separated (default {','.join(WORLDS)})")
    parser.add_argument("--manoeuvres", help=f"on level ground, comma-separated (default {','.join(WAYS)})")
    parser.add_argument("--seed", type=int, default=1, help="of world and sensor noise (default 1)")
    parser.add_argument("--jobs", type=int, default=1, help="walks at a time, a core each (default 1)")
    parser.add_argument("--pictures", metavar="DIR", help="also photograph the robots, as PNG files in this folder")
    parser.add_argument("--report", metavar="FILE.md", help="write the tables, short and whole, to this file")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
