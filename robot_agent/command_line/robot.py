"""`weaver robot`: the robot's own processes. `--role vision` turns pictures and inertia into pose, map and gait."""

from __future__ import annotations

import argparse
import signal
import threading

import cv2

from robot_agent.vision_process import VisionProcess
from weaver_shared.bus import ZenohBus
from weaver_shared.errors import ResourceError
from weaver_shared.robots import load_robot


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    robot = load_robot(options.robot)
    if options.role != "vision":
        raise ResourceError(
            f"role {options.role!r} needs a servo bus and none is configured; a simulated body walks with `weaver sim`"
        )
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    cv2.setNumThreads(1)
    bus = ZenohBus(listen=[options.listen], connect=options.connect.split(",") if options.connect else [])
    try:
        VisionProcess(robot_id=options.robot_id, robot=robot, bus=bus).run(ended)
    finally:
        bus.close()
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver robot", description=__doc__)
    parser.add_argument("--role", choices=("walk", "vision", "all"), default="all", help="which loops to run")
    parser.add_argument("--robot", default="weaver", help="robot description: a shipped name or a TOML file")
    parser.add_argument("--robot-id", default="sim-1", help="name on the bus, unique per robot")
    parser.add_argument("--listen", default="tcp/127.0.0.1:0", help="bus endpoint to listen on")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    return parser
