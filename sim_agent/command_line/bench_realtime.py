"""`weaver bench realtime`: the whole product in real time on this machine, first without and then with a page open."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from tqdm import tqdm

from weaver_shared import topics
from weaver_shared.bus import ZenohBus, free_port
from weaver_shared.errors import ResourceError
from weaver_shared.messages import CommandName, Health, LoopTiming, Waypoint
from weaver_shared.operator import Operator
from weaver_shared.quiet_chromium import FLAGS

ROBOT_ID = "bench"
OPERATOR = "bench"
CHROMIUM = ["--headless", *FLAGS, "--window-size=1440,900"]


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="weaver bench realtime", description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="s of measurement in each of the two parts")
    parser.add_argument("--world", default="testbed", help="flat, testbed, outdoor, stairs, wall or pen")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    figures = {
        "without_browser": _part(options, browser=False),
        "with_page": _part(options, browser=True) if shutil.which("chromium") else None,
        "cores": os.cpu_count(),
    }
    print(json.dumps(figures) if options.json else json.dumps(figures, indent=2))
    return 0


def _part(options: argparse.Namespace, *, browser: bool) -> dict[str, Any]:
    with contextlib.ExitStack() as stack:
        port = free_port()
        started = stack.enter_context(_product(options.world, port))
        operator = stack.enter_context(contextlib.closing(_Driver(started["bus"])))
        operator.begin()
        if browser:
            stack.enter_context(_page(port))
            time.sleep(5.0)
        before = {name: _cpu_seconds(pid) for name, pid in started["pids"].items()}
        operator.timings.clear()
        began = time.monotonic()
        for _ in tqdm(range(round(options.seconds)), unit="s", disable=not sys.stderr.isatty(), file=sys.stderr):
            time.sleep(1.0)
        elapsed = time.monotonic() - began
        cpu = {name: (_cpu_seconds(pid) - before[name]) / elapsed for name, pid in started["pids"].items()}
        return {"loops": operator.summary(), "cpu_cores": cpu, "mode": operator.mode, "notes": started["notes"]}


@contextlib.contextmanager
def _product(world: str, port: int) -> Iterator[dict[str, Any]]:
    """`weaver up` as a user starts it; yields its bus endpoint and process ids once the page answers."""
    command = [sys.executable, "-m", "weaver_shared.command_line", "up", "--no-browser", "--world", world]
    command += ["--port", str(port), "--robot-id", ROBOT_ID]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        if process.stdout is None or process.stderr is None:
            raise ResourceError("the product's output could not be read")
        first = process.stderr.readline()
        if not first.startswith("{"):
            raise ResourceError(f"`weaver up` did not start: {first.strip()}")
        notes: list[str] = []
        threading.Thread(target=notes.extend, args=(process.stderr,), daemon=True).start()
        if not process.stdout.readline():
            raise ResourceError("`weaver up` ended before its page answered")
        yield json.loads(first) | {"notes": notes}
    finally:
        process.terminate()
        process.wait(10.0)


@contextlib.contextmanager
def _page(port: int) -> Iterator[None]:
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        address = f"http://127.0.0.1:{port}/"
        command = ["nice", "-n", "5", "chromium", *CHROMIUM, f"--user-data-dir={profile}", "--remote-debugging-port=0"]
        process = subprocess.Popen([*command, address], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            yield
        finally:
            process.terminate()
            process.wait(10.0)


@dataclass
class _Driver:
    """Takes control over the bus, walks the robot to and fro, and collects the loops' own timing."""

    endpoint: str
    timings: list[LoopTiming] = field(default_factory=list)
    mode: str = ""

    def __post_init__(self) -> None:
        self._bus = ZenohBus(connect=[self.endpoint])
        self._bus.subscribe(ROBOT_ID, topics.HEALTH, self._hear)
        self._bus.subscribe(ROBOT_ID, topics.MODE, self._note_mode)
        self._operator = Operator(self._bus, ROBOT_ID, OPERATOR)

    def begin(self) -> None:
        """Stand up and set off; returns when the robot walks."""
        self._until(lambda: self._bus.alive(ROBOT_ID), 30.0, "the robot did not appear")
        self._until(lambda: self._send(CommandName.TAKE_CONTROL), 30.0, "control was not granted")
        self._operator.retain_in_background()
        self._until(lambda: self._send(CommandName.STAND), 30.0, "the robot did not stand up")
        there_and_back = (Waypoint(x=2.0, y=0.0), Waypoint(x=0.0, y=0.0)) * 5
        self._send(CommandName.SET_MISSION, waypoints=there_and_back)
        self._until(lambda: self._send(CommandName.START_MISSION) and self.mode == "WALK", 60.0, "it did not walk")

    def summary(self) -> dict[str, dict[str, float]]:
        result = {}
        for name in sorted({timing.name for timing in self.timings}):
            mine = [timing for timing in self.timings if timing.name == name]
            result[name] = {
                "rate_hz": float(np.mean([timing.rate for timing in mine])),
                "period_error_p99_ms": float(np.percentile([t.period_error_p99 for t in mine], 50) * 1e3),
                "period_error_worst_ms": float(np.max([t.period_error_p99 for t in mine]) * 1e3),
                "overruns": sum(timing.overruns for timing in mine),
                "real_time_factor": float(np.mean([timing.real_time_factor for timing in mine])),
            }
        return result

    def close(self) -> None:
        self._operator.close()
        self._bus.close()

    def _send(self, command: CommandName, *, waypoints: tuple[Waypoint, ...] = ()) -> bool:
        try:
            return self._operator.send(command, waypoints=waypoints).accepted
        except ResourceError:
            return False

    def _until(self, done: Any, timeout: float, otherwise: str) -> None:
        deadline = time.monotonic() + timeout
        while not done():
            if time.monotonic() > deadline:
                raise ResourceError(f"{otherwise} within {timeout:.0f} s (its state is {self.mode or 'unknown'})")
            time.sleep(0.25)

    def _hear(self, _robot_id: str, _key: str, health: Health) -> None:
        self.timings.extend(health.timings)

    def _note_mode(self, _robot_id: str, _key: str, state: Any) -> None:
        self.mode = state.mode


def _cpu_seconds(pid: int) -> float:
    """User and system time a process has used, in s; zero once it is gone."""
    with contextlib.suppress(OSError):
        with open(f"/proc/{pid}/stat") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return 0.0
