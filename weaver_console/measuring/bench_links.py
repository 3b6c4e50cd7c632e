"""`weaver bench links`: however an operator is lost, how soon the robot is still, and what a page is told on return.

A simulated robot, a console and, for the last case, a guarded bus are processes; the operator's page drives by hand or
by cruise over ways that can fall silent. Someone who watches past the console takes the times, from the loss on.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import os
import signal
import sys
import tempfile
import time
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import numpy as np

from weaver_console.measuring.driving_page import DRIVES, DrivingPage
from weaver_console.measuring.guarded_bus import GuardedBus
from weaver_console.measuring.processes import MeasuredProcess, console_process
from weaver_console.measuring.robot_watch import RobotWatch
from weaver_console.measuring.silent_way import SilentWay
from weaver_shared.bus import ZenohBus, free_port
from weaver_shared.bus_security import own_settings
from weaver_shared.errors import InputError, ResourceError

ROBOT = "link-1"
STILL_WITHIN = 1.5  # s
WATCHED = 5.0  # s after the loss
CASES = (
    "page closed",
    "tab frozen",
    "network dropped between page and console",
    "network dropped between console and robot",
    "console killed",
    "router killed",
)


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    wanted = [case for case in CASES if options.only in case]
    if not wanted:
        raise InputError(f"no case is called like {options.only!r}; there are {', '.join(CASES)}")
    drives = options.drive.split(",")
    if unknown := [how for how in drives if how not in DRIVES]:
        raise InputError(f"the robot can not be driven by {', '.join(unknown)}; known are {', '.join(DRIVES)}")
    figures = asyncio.run(measure(wanted, drives))
    if options.json:
        print(json.dumps(figures))
    else:
        for case, drives in figures["cases"].items():
            for how, one in drives.items():
                print(
                    f"{case:44} {how:7} ordered {one['ordered_s']:5.2f} s, still {one['still_s']:5.2f} s: {one['told']}"
                )
    return 0 if figures["all_still_in_time"] else 1


async def measure(cases: list[str], drives: list[str]) -> dict[str, Any]:
    found: dict[str, dict[str, Any]] = {}
    for guarded in (False, True):
        own = [case for case in cases if (case == "router killed") is guarded]
        if own:
            async with _rig(guarded=guarded) as rig:
                for case in own:
                    for how in drives:
                        _tell(f"{case}, driven by {how}")
                        found.setdefault(case, {})[how] = await rig.lose(case, how)
    times = [one["still_s"] for drives_of in found.values() for one in drives_of.values()]
    return {
        "cases": found,
        "longest_still_s": max(times, default=None),
        "still_within_s": STILL_WITHIN,
        "all_still_in_time": all(time_s <= STILL_WITHIN for time_s in times),
        "load_average": round(os.getloadavg()[0], 1),
    }


class Rig:
    """The processes and the ways between them."""

    def __init__(self, stack: contextlib.AsyncExitStack, folder: Path, *, guarded: bool) -> None:
        self._stack, self._folder = stack, folder
        self._guard = GuardedBus(folder, robots={"computer": [ROBOT]}) if guarded else None
        self._ports = {name: free_port() for name in ("robot", "bus", "console", "page", "bus of the console")}
        self._pages, self._bus = SilentWay(self._ports["console"]), SilentWay(self._ports["robot"])
        self._direction = 1.0

    async def start(self) -> None:
        await self._pages.open(self._ports["page"])
        await self._bus.open(self._ports["bus"])
        self._stack.push_async_callback(self._pages.close)
        self._stack.push_async_callback(self._bus.close)
        if self._guard is not None:
            self._start_router()
            await asyncio.sleep(2.0)
        walking = ["sim", "--robot-id", ROBOT, "--world", "flat", "--stand"]
        ends = ["--connect", self._router] if self._guard else [
            "--listen", f"tcp/127.0.0.1:{self._ports['robot']}", "--connect", f"tcp/127.0.0.1:{free_port()}",
        ]  # fmt: skip
        robot = MeasuredProcess(
            "weaver_shared.command_line", *walking, *ends, environment=self._environment("computer")
        )
        self._stack.callback(robot.end)
        await self._start_console()
        settings: dict[str, object] = {"mode": "client", "listen/endpoints": []}
        if self._guard is not None:
            settings = own_settings(self._environment("viewer"))
        at = self._router if self._guard else f"tcp/127.0.0.1:{self._ports['robot']}"
        bus = await _patiently(lambda: ZenohBus(connect=[at], settings=settings))
        self._stack.callback(bus.close)
        self._watch = RobotWatch(bus, ROBOT)
        await _until(lambda: self._watch.mode is not None and self._watch.mode.mode in ("STAND", "HOLD"), "stand")

    async def lose(self, case: str, how: str) -> dict[str, Any]:
        page = DrivingPage(self._ports["page"], ROBOT)
        await page.enter()
        await page.insist("take_control", reason="measuring")
        await page.drive(how, self._direction)
        self._direction = -self._direction
        await _until(lambda: self._watch.speed > 0.05, "walk")
        await asyncio.sleep(1.5)
        speed, place, lost = self._watch.speed, self._watch.place, time.monotonic()
        await self._cut(case, page)
        await asyncio.sleep(WATCHED)
        seen = {"ordered_s": self._watch.ordered - lost, "still_s": self._watch.moved - lost}
        await page.leave()
        await self._restore(case)
        back = DrivingPage(self._ports["page"], ROBOT)
        await back.enter()
        if case == "router killed":  # nobody can watch meanwhile: told by the way that it went on
            await _until(lambda: self._watch.heard > lost + WATCHED, "come back")
            seen["ordered_s"] = seen["still_s"] = float(np.hypot(*(self._watch.place - place))) / speed
        told = [text for text in back.told if "has been silent" in text or "no heartbeat" in text]
        refused = await back.command("sit")
        mode = self._watch.mode
        await back.leave()
        return {name: round(max(0.0, value), 2) for name, value in seen.items()} | {
            "speed_before": round(speed, 2),
            "mode": mode.mode if mode is not None else "",
            "refused": refused["reason"],
            "told": told[-1] if told else "; ".join(mode.reasons if mode is not None else ()),
        }

    async def _cut(self, case: str, page: DrivingPage) -> None:
        if case == "page closed":
            await page.leave()
        elif case == "tab frozen":
            page.freeze()
        elif case.endswith("page and console"):
            self._pages.cut()
        elif case.endswith("console and robot"):
            self._bus.cut()
        else:
            os.kill((self._console if case == "console killed" else self._routing).pid, signal.SIGKILL)

    async def _restore(self, case: str) -> None:
        self._pages.restore()
        self._bus.restore()
        if case == "console killed":
            self._console.end()
            await self._start_console()
        elif case == "router killed":
            self._routing.end()
            self._start_router()

    @property
    def _router(self) -> str:
        return f"tls/127.0.0.1:{self._ports['robot']}"

    def _environment(self, name: str) -> dict[str, str]:
        return self._guard.environment(name) if self._guard is not None else {}

    def _start_router(self) -> None:
        assert self._guard is not None
        options = ["router", "--listen", self._router, *self._guard.router_options]
        self._routing = MeasuredProcess("weaver_shared.command_line", *options)
        self._stack.callback(self._routing.end)

    async def _start_console(self) -> None:
        ends = ["--connect", self._router] if self._guard else [
            "--connect", f"tcp/127.0.0.1:{self._ports['bus']}",
            "--listen", f"tcp/127.0.0.1:{self._ports['bus of the console']}",
        ]  # fmt: skip
        self._console = await asyncio.to_thread(
            console_process, self._ports["console"], str(self._folder), "--no-scene", *ends,
            environment=self._environment("console"),
        )  # fmt: skip
        self._stack.callback(self._console.end)


@contextlib.asynccontextmanager
async def _rig(*, guarded: bool) -> AsyncIterator[Rig]:
    with tempfile.TemporaryDirectory() as folder:
        async with contextlib.AsyncExitStack() as stack:
            rig = Rig(stack, Path(folder), guarded=guarded)
            _tell("starting the robot and the console" + (" on a guarded bus" if guarded else ""))
            await rig.start()
            yield rig


async def _until(condition: Any, what: str, timeout: float = 60.0) -> None:
    try:
        async with asyncio.timeout(timeout):
            while not condition():
                await asyncio.sleep(0.02)
    except TimeoutError as error:
        raise ResourceError(f"the robot did not {what} within {timeout:.0f} s") from error


async def _patiently(make: Any, timeout: float = 30.0) -> Any:
    deadline = time.monotonic() + timeout
    while True:
        try:
            return make()
        except ResourceError:
            if time.monotonic() > deadline:
                raise
            await asyncio.sleep(0.5)


def _tell(text: str) -> None:
    print(f"bench links: {text}", file=sys.stderr, flush=True)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver bench links", description=__doc__)
    parser.add_argument("--only", default="", help="only cases whose name contains this")
    parser.add_argument("--drive", default=",".join(DRIVES), help="how the robot is driven (%(default)s)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
