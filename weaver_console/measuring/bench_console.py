"""`weaver bench console`: what pages cost the console, and how soon they see and are answered.

A robot that talks 30 times a second over a 10 x 10 m map of which nine tiles change ten times a second; a console; and
pages, each with its 3-D view. Delays run from the robot's stamp to the page's hands, on one computer's clock.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from weaver_console.measuring.narrow_way import NarrowWay
from weaver_console.measuring.page_client import Heard, PageClient
from weaver_console.measuring.percentiles import percentiles_ms
from weaver_console.measuring.processes import MeasuredProcess, console_process
from weaver_console.measuring.real_page import measure_real_page
from weaver_console.measuring.scene_watcher import SceneWatcher
from weaver_shared.bus import free_port
from weaver_shared.errors import InputError, ResourceError

ROBOT = "made-1"
NARROW = 100_000.0  # bytes/s
SETTLING = 4.0  # s until a whole map has been drawn and sent
TRIAL = {
    "state_ms": {"p50": 1.4, "p99": 8.0},
    "command_ms": {"p50": 2.0, "p99": 9.0},
    "terrain_update_kb": 96.0,
    "cpu_percent_of_a_core_with_4_pages": 25.0,
    "usable_ms": 2000.0,
}
"""Measured of a first attempt of this console, which this one is to keep under; and how soon a page is to be of use."""

CROWDS = {"1 page, in Chromium": 0, "4 pages, one in Chromium": 3, "10 pages, one in Chromium": 9}
"""How many pages of others there are beside a real browser; the first of them has a narrow way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    pages: int
    narrow: int = 0  # of them behind 100 kB/s
    scenes: bool = True
    map_rate: float = 10.0  # Hz


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    cases = {
        "1 page": Case(pages=1),
        "1 page, still map": Case(pages=1, map_rate=0.0),
        "4 pages": Case(pages=4),
        "4 pages, 2-D only": Case(pages=4, scenes=False),
        "4 pages, one at 100 kB/s": Case(pages=4, narrow=1),
        "10 pages": Case(pages=10),
        "10 pages, one at 100 kB/s": Case(pages=10, narrow=1),
    }
    wanted = {name: case for name, case in cases.items() if options.only in name}
    crowds = {name: others for name, others in CROWDS.items() if options.only in name}
    if not (wanted or crowds):
        raise InputError(f"no case is called like {options.only!r}; there are {', '.join((*cases, *CROWDS))}")
    figures: dict[str, Any] = {}
    for name, case in wanted.items():
        print(f"bench console: {name}", file=sys.stderr, flush=True)
        figures[name] = measure(case, options.seconds)
    _add_scene_update(figures)
    real = _measure_real_pages(options.clicks, crowds) if options.browser else {"skipped": "not asked for"}
    if options.json:
        print(json.dumps({"console": figures, "real_page": real, "goal": TRIAL}))
    else:
        _print(figures, real)
    return 0


def _measure_real_pages(clicks: int, crowds: dict[str, int]) -> dict[str, Any]:
    figures: dict[str, Any] = {}
    for name, others in crowds.items():
        print(f"bench console: {name}", file=sys.stderr, flush=True)
        figures[name] = measure_real_page(clicks, others, narrow_rate=NARROW)
    return figures


def measure(case: Case, seconds: float) -> dict[str, Any]:
    port, endpoint = free_port(), f"tcp/127.0.0.1:{free_port()}"
    scenes = [] if case.scenes else ["--no-scene"]
    made = ["--robot-id", ROBOT, "--connect", endpoint, "--extent", "10", "--map-rate", str(case.map_rate)]
    with (
        tempfile.TemporaryDirectory() as data,
        console_process(port, data, "--listen", endpoint, *scenes) as console,
        MeasuredProcess("weaver_console.measuring.made_robot", *made) as robot,
    ):
        figures = asyncio.run(_watch(case, port, console, seconds))
        robot.require_running()
        return figures


async def _watch(case: Case, port: int, console: MeasuredProcess, seconds: float) -> dict[str, Any]:
    pages = [PageClient(number, robot=ROBOT, commands=number == case.narrow) for number in range(case.pages)]
    watchers = [SceneWatcher() for _ in pages]
    narrow = NarrowWay(port, rate=NARROW)
    narrow_port = await narrow.open()
    ports = [narrow_port if number < case.narrow else port for number in range(case.pages)]
    running = [asyncio.create_task(page.run(at)) for page, at in zip(pages, ports, strict=True)]
    try:
        await _until(
            lambda: all(page.scene or not case.scenes for page in pages) and all(page.heard.states for page in pages)
        )
        if case.scenes:
            running += [
                asyncio.create_task(watcher.run(at, page.scene or ""))
                for page, watcher, at in zip(pages, watchers, ports, strict=True)
            ]
        await asyncio.sleep(SETTLING)
        for page in pages:
            page.begin()
        before, scene_before = console.cpu_seconds(), [watcher.bytes for watcher in watchers]
        await asyncio.sleep(seconds)
        cpu = (console.cpu_seconds() - before) / seconds
        scene_bytes = [watcher.bytes - old for watcher, old in zip(watchers, scene_before, strict=True)]
        for task in running:
            if task.done() and (error := task.exception()) is not None:
                raise ResourceError(f"a page was lost: {error}") from error
    finally:
        for task in running:
            task.cancel()
        await asyncio.gather(*running, return_exceptions=True)
        await narrow.close()
    heard = [page.heard for page in pages]
    return {
        "cpu_percent": round(100.0 * cpu, 1),
        "cpu_percent_a_page": round(100.0 * cpu / case.pages, 1),
        "memory_mb": round(console.memory() / 1e6),
        "pages": _summary(heard[case.narrow :], scene_bytes[case.narrow :], seconds),
    } | ({"throttled": _summary(heard[: case.narrow], scene_bytes[: case.narrow], seconds)} if case.narrow else {})


def _summary(heard: list[Heard], scene_bytes: list[int], seconds: float) -> dict[str, Any]:
    states = [delay for one in heard for delay in one.states]
    tiles = [delay for one in heard for delay in one.tiles]
    trips = [trip for one in heard for trip in one.round_trips]
    tile_count = max(1, len(tiles))
    return {
        "page_kb_per_s": round(sum(one.bytes for one in heard) / len(heard) / seconds / 1e3, 1),
        "scene_kb_per_s": round(sum(scene_bytes) / len(heard) / seconds / 1e3, 1),
        "states_per_s": round(len(states) / len(heard) / seconds, 1),
        "tiles_per_s": round(len(tiles) / len(heard) / seconds, 1),
        "page_kb_per_nine_tiles": round(9 * sum(one.tile_bytes for one in heard) / tile_count / 1e3, 1),
        "state_ms": percentiles_ms(states, 50, 99),
        "tile_ms": percentiles_ms(tiles, 50, 99),
        "command_ms": percentiles_ms(trips, 50, 99),
    }


def _add_scene_update(figures: dict[str, Any]) -> None:
    """Bytes of an update in the 3-D view: what the changing map adds to the still one."""
    if "1 page" in figures and "1 page, still map" in figures:
        moving, still = (figures[name]["pages"]["scene_kb_per_s"] for name in ("1 page", "1 page, still map"))
        figures["1 page"]["scene_kb_per_update"] = round((moving - still) / Case(pages=1).map_rate, 1)


async def _until(condition: Any, timeout: float = 20.0) -> None:
    async with asyncio.timeout(timeout):
        while not condition():
            await asyncio.sleep(0.05)


def _print(figures: dict[str, Any], real: dict[str, Any]) -> None:
    print(f"{'':28} CPU  /page    page kB/s  3-D kB/s  state p50/p99 ms  command p50/p99 ms  tile p50/p99 ms")
    for name, case in figures.items():
        for who in ("pages", "throttled"):
            if who not in case:
                continue
            one = case[who]
            label = name if who == "pages" else "    the throttled one"
            cpu = f"{case['cpu_percent']:5.1f} {case['cpu_percent_a_page']:6.1f}" if who == "pages" else " " * 12
            print(
                f"{label:28}{cpu} {one['page_kb_per_s']:10.1f} {one['scene_kb_per_s']:9.1f}"
                f"  {_pair(one['state_ms'], ('p50', 'p99'))}  {_pair(one['command_ms'], ('p50', 'p99'))}"
                f"  {_pair(one['tile_ms'], ('p50', 'p99'))}"
            )
    for name, one in real.items():
        print(f"{name}: {one}")


def _pair(values: dict[str, float | None], names: Iterable[str]) -> str:
    return " / ".join("-" if values[name] is None else f"{values[name]:.1f}" for name in names).rjust(16)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver bench console", description=__doc__)
    parser.add_argument("--seconds", type=float, default=15.0, help="measured of each case, s (%(default)s)")
    parser.add_argument("--clicks", type=int, default=60, help="clicks in the real browser (%(default)s)")
    parser.add_argument("--only", default="", help="only cases whose name contains this")
    parser.add_argument("--no-browser", dest="browser", action="store_false", help="measure no real browser")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
