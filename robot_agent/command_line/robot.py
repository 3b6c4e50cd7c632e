"""`weaver robot`: the robot's own processes.

`--role walk` walks the servos of a wiring file; `--role vision` turns pictures and inertia into pose, map and gait.
"""

from __future__ import annotations

import argparse
import logging
import signal
import threading
import time
from pathlib import Path

import cv2

from robot_agent.hardware.opening import open_robot
from robot_agent.hardware.presence import require_devices
from robot_agent.hardware.wiring import Wiring, load_wiring
from robot_agent.loops import WalkLoop
from robot_agent.vision_process import VisionProcess
from weaver_shared.bus import ZenohBus
from weaver_shared.errors import ConfigurationError, ResourceError
from weaver_shared.robots import load_robot

JOIN_SECONDS = 1.0
"""How long to look for another robot of the same id before taking the name."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.WARNING)
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    cv2.setNumThreads(1)
    bus = ZenohBus(listen=[options.listen], connect=options.connect.split(",") if options.connect else [])
    try:
        if options.role == "walk":
            _walk(options, bus, ended)
        else:
            VisionProcess(robot_id=options.robot_id, robot=load_robot(options.robot or "weaver"), bus=bus).run(ended)
    finally:
        bus.close()
    return 0


def _walk(options: argparse.Namespace, bus: ZenohBus, ended: threading.Event) -> None:
    if options.wiring is None:
        raise ConfigurationError("role 'walk' needs --wiring FILE, which says where the servos are")
    if "walk" in bus.alive(options.robot_id, timeout=JOIN_SECONDS):
        raise ResourceError(f"a robot called {options.robot_id!r} is already on the bus; choose another --robot-id")
    _wait_for(options.wiring, options.wait, ended)
    config = load_wiring(options.wiring)
    require_devices(config)
    robot = load_robot(options.robot or config.robot)
    body = open_robot(Wiring(config, robot))
    try:
        loop = WalkLoop(robot_id=options.robot_id, body=body, bus=bus, world=options.world)
        if options.stand:
            loop.desk.stand_unattended()
        while not ended.is_set():
            loop.tick()
    finally:
        body.close()


def _wait_for(path: Path, seconds: float, ended: threading.Event) -> None:
    """Until the file is there: an emulated robot may still be getting up."""
    deadline = time.monotonic() + seconds
    while not path.exists() and time.monotonic() < deadline and not ended.is_set():
        ended.wait(0.1)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver robot", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--role", choices=("walk", "vision"), required=True, help="which of its loops to run")
    parser.add_argument("--wiring", type=Path, metavar="FILE", help="where the devices are; see `weaver doctor`")
    parser.add_argument("--wait", type=float, default=0.0, help="s to wait for the wiring file")
    parser.add_argument("--robot", help="robot description: a name or a TOML file (default: the wiring's)")
    parser.add_argument("--world", default="", help="what the console calls the place")
    parser.add_argument("--stand", action="store_true", help="stand up at once, without an operator's command")
    parser.add_argument("--robot-id", default="sim-1", help="name on the bus, unique per robot")
    parser.add_argument("--listen", default="tcp/127.0.0.1:0", help="bus endpoint to listen on")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    return parser
