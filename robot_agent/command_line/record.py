"""`weaver record`: writes down what a robot says, at once or as its operators ask."""

from __future__ import annotations

import argparse
import logging
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from robot_agent.recording import Recorder, RecordingWriter
from robot_agent.recording.store import RecordingStore
from robot_agent.recording_process import RecordingProcess
from robot_agent.replays import Replays
from weaver_shared.bus import ZenohBus
from weaver_shared.clock import MonotonicClock
from weaver_shared.robots import RobotDescription, load_robot


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    robot = load_robot(options.robot)
    ended = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: ended.set())
    endpoints = options.connect.split(",") if options.connect else []

    def open_bus() -> ZenohBus:
        return ZenohBus(connect=endpoints)

    if options.file is not None:
        return _record(options, robot, open_bus, ended)
    bus = open_bus()
    try:
        RecordingProcess(
            robot_id=options.robot_id,
            robot=robot,
            bus=bus,
            open_bus=open_bus,
            store=RecordingStore(options.folder),
            replays=Replays(lambda path, name: _start_replay(path, name, options.connect)),
            clock=MonotonicClock(),
            wall_time=_now,
        ).run(ended)
    finally:
        bus.close()
    return 0


def _record(
    options: argparse.Namespace,
    robot: RobotDescription,
    open_bus: Callable[[], ZenohBus],
    ended: threading.Event,
) -> int:
    """One file, from now until Ctrl-C."""
    writer = RecordingWriter(
        options.file,
        robot_id=options.robot_id,
        robot=robot,
        clock=MonotonicClock(),
        started=_now().isoformat(timespec="seconds"),
        pictures=options.pictures,
    )
    bus = open_bus()
    try:
        recorder = Recorder(bus, options.robot_id, writer, pictures=options.pictures)
        while not ended.is_set():
            recorder.turn(0.1)
    finally:
        bus.close()
        writer.close()
    lost = f", {recorder.lost} messages lost to a slow disk" if recorder.lost else ""
    print(f"{writer.path}: {writer.seconds:.1f} s of {options.robot_id}{lost}", file=sys.stderr)
    return 0


def _start_replay(path: Path, name: str, endpoints: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "weaver_shared.command_line", "replay", str(path), "--robot-id", name]
    command += ["--connect", endpoints, "--attended"]
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, preexec_fn=lambda: os.nice(10))  # noqa: PLW1509


def _now() -> datetime:
    return datetime.now().astimezone()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver record", description="Record what a robot says on the bus, with its pictures, as MCAP."
    )
    parser.add_argument("file", metavar="FILE", type=Path, nargs="?", help=".mcap to write from now until Ctrl-C; "
                        "without it, wait to be told by the console")  # fmt: skip
    parser.add_argument("--folder", type=Path, default=Path("recordings"), help="where those of the console go")
    parser.add_argument("--no-pictures", dest="pictures", action="store_false", help="with FILE: no stereo pairs")
    parser.add_argument("--robot-id", default="sim-1", help="name of the robot on the bus")
    parser.add_argument("--robot", default="weaver", help="robot description: a shipped name or a TOML file")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    return parser
