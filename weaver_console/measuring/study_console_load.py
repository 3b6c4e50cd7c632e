"""`weaver study console-load`: a fleet's telemetry and many viewers on one console, over a guarded bus.

Robots that only talk, a router with TLS, users and access control as in docker-compose.yml, and a console are processes
of their own; pages are WebSocket clients. Delays run from a robot's stamp to a page's hands.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

from weaver_console.measuring.guarded_bus import GuardedBus
from weaver_console.measuring.page_client import PageClient
from weaver_console.measuring.percentiles import percentiles_ms
from weaver_console.measuring.processes import MeasuredProcess, console_process
from weaver_shared.bus import free_port
from weaver_shared.errors import ConfigurationError, ResourceError

A_PROCESS = 5
"""Robots that one process speaks for."""

SETTLING = 3.0
PATIENCE = 60.0


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.robots < 1 or options.viewers < 1 or options.seconds <= 0.0:
        raise ConfigurationError("there must be at least one robot, one viewer and some time")
    figures = measure(options.robots, options.viewers, options.seconds)
    if options.json:
        print(json.dumps(figures))
        return 0
    for name, process in figures["processes"].items():
        print(f"{name:10} {process['cpu_percent']:6.1f} % of a core {process['memory_mb']:6.0f} MB")
    for name in ("state_ms", "command_ms"):
        one = figures[name]
        print(f"{name:10} p50 {one['p50']} p95 {one['p95']} p99 {one['p99']} of {one['count']}")
    print(f"{figures['states_per_s']} states/s and {figures['page_kb_per_s']} kB/s a page")
    return 0


def measure(robots: int, viewers: int, seconds: float) -> dict[str, Any]:
    ids = [f"made-{number}" for number in range(robots)]
    computers = {f"computer-{k}": ids[k * A_PROCESS : (k + 1) * A_PROCESS] for k in range(-(-robots // A_PROCESS))}
    port, endpoint = free_port(), f"tls/127.0.0.1:{free_port()}"
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        bus = GuardedBus(Path(folder), robots=computers)
        _tell("starting the router, the console and the robots")
        router = ["router", "--listen", endpoint, *bus.router_options]
        processes = {"router": stack.enter_context(MeasuredProcess("weaver_shared.command_line", *router))}
        console = console_process(
            port, folder, "--connect", endpoint, "--no-scene", environment=bus.environment("console")
        )
        processes["console"] = stack.enter_context(console)
        for name, own in computers.items():
            options = ["--connect", endpoint, *(word for robot_id in own for word in ("--robot-id", robot_id))]
            made = MeasuredProcess("weaver_console.measuring.made_robot", *options, environment=bus.environment(name))
            processes[name] = stack.enter_context(made)
        watched = [PageClient(number, robot=ids[number % robots], commands=number == 0) for number in range(viewers)]
        costs = asyncio.run(_watch(watched, port, processes, seconds))
    heard = [page.heard for page in watched]
    return {
        "robots": robots,
        "viewers": viewers,
        "load_average": round(os.getloadavg()[0], 1),
        "processes": costs,
        "states_per_s": round(sum(len(one.states) for one in heard) / viewers / seconds, 1),
        "page_kb_per_s": round(sum(one.bytes for one in heard) / viewers / seconds / 1e3, 1),
        "state_ms": percentiles_ms([delay for one in heard for delay in one.states], 50, 95, 99),
        "command_ms": percentiles_ms([trip for one in heard for trip in one.round_trips], 50, 95, 99),
    }


async def _watch(
    pages: list[PageClient], port: int, processes: dict[str, MeasuredProcess], seconds: float
) -> dict[str, dict[str, float]]:
    running = [asyncio.create_task(page.run(port)) for page in pages]
    try:
        async with asyncio.timeout(PATIENCE):
            while not all(page.heard.states for page in pages):
                await asyncio.sleep(0.1)
        await asyncio.sleep(SETTLING)
        _tell(f"measuring for {seconds:.0f} s")
        for page in pages:
            page.begin()
        before = {name: process.cpu_seconds() for name, process in processes.items()}
        await asyncio.sleep(seconds)
        return {
            name: {
                "cpu_percent": round(100.0 * (process.cpu_seconds() - before[name]) / seconds, 1),
                "memory_mb": round(process.memory() / 1e6),
            }
            for name, process in processes.items()
        }
    except TimeoutError as error:
        silent = sum(not page.heard.states for page in pages)
        raise ResourceError(f"{silent} of {len(pages)} viewers heard nothing within {PATIENCE:.0f} s") from error
    finally:
        for task in running:
            task.cancel()
        await asyncio.gather(*running, return_exceptions=True)


def _tell(text: str) -> None:
    print(f"study console-load: {text}", file=sys.stderr, flush=True)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver study console-load", description=__doc__)
    parser.add_argument("--robots", type=int, default=20, help="robots that only send telemetry (%(default)s)")
    parser.add_argument("--viewers", type=int, default=10, help="pages that watch (%(default)s)")
    parser.add_argument("--seconds", type=float, default=20.0, help="measured, s (%(default)s)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
