"""`weaver sim`: physics and walking of one simulated robot, in real time, on the bus."""

from __future__ import annotations

import argparse
import signal
import threading

from robot_agent.loops import CONTROL_RATE, WalkLoop
from sim_agent.body import SimulatedBody
from sim_agent.realtime import Pacer, run_paced
from sim_agent.worlds import make_world
from weaver_shared import topics
from weaver_shared.bus import ZenohBus
from weaver_shared.clock import MonotonicClock
from weaver_shared.errors import ResourceError
from weaver_shared.robots import load_robot

JOIN_SECONDS = 1.0
"""How long to look for another robot of the same id before taking the name."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    robot = load_robot(options.robot)
    world = make_world(options.world, options.seed)
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    bus = ZenohBus(listen=[options.listen], connect=options.connect.split(",") if options.connect else [])
    try:
        if "walk" in bus.alive(options.robot_id, timeout=JOIN_SECONDS):
            raise ResourceError(f"a robot called {options.robot_id!r} is already on the bus; choose another --robot-id")
        body = SimulatedBody(robot, world, options.seed)
        loop = WalkLoop(robot_id=options.robot_id, body=body, bus=bus, world=world.name)
        if options.stand:
            loop.desk.stand_unattended()
        count = 0

        def tick() -> None:
            nonlocal count
            loop.tick()
            if body.camera_due():
                bus.publish(options.robot_id, topics.SCENE, body.scene_state())
            if count % 2 == 0:
                bus.publish(options.robot_id, topics.TRUTH, body.truth())
            count += 1

        run_paced(tick, Pacer(MonotonicClock(), period=1.0 / CONTROL_RATE), ended.is_set)
        body.close()
    finally:
        bus.close()
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver sim", description=__doc__)
    parser.add_argument("--robot", default="weaver", help="robot description: a shipped name or a TOML file")
    parser.add_argument("--robot-id", default="sim-1", help="name on the bus, unique per robot")
    parser.add_argument("--world", default="testbed", help="flat, testbed, outdoor, stairs, wall or pen")
    parser.add_argument("--seed", type=int, default=1, help="seed of the world and of all sensor noise")
    parser.add_argument("--stand", action="store_true", help="stand up at once, without an operator's command")
    parser.add_argument("--listen", default="tcp/127.0.0.1:0", help="bus endpoint to listen on")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    return parser
