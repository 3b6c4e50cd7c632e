"""`weaver twin`: a robot that does not exist, behind the serial lines of one that does, and what can go wrong with it.

`run` serves it, as `weaver up --robot twin` does; `inject` makes something go wrong with a running one; `faults` lists
what can.
"""

from __future__ import annotations

import argparse
import json
import signal
import sys
import threading
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from robot_agent.hardware.wiring import Wiring
from sim_agent.body import CONTROL_RATE, SimulatedBody
from sim_agent.realtime import Pacer, run_paced
from sim_agent.servo_bus.twin_wiring import twin_wiring, wiring_file
from sim_agent.twin.fault_desk import FaultDesk, ask
from sim_agent.twin.faults import FAULTS, Devices
from sim_agent.twin.real_time import RealTimeTwin
from sim_agent.twin.twin_time import TwinTime
from sim_agent.worlds import make_world
from weaver_shared import topics
from weaver_shared.bus import ZenohBus
from weaver_shared.clock import MonotonicClock
from weaver_shared.config.hardware import ServoSettings
from weaver_shared.robots import load_robot
from weaver_shared.topics import robot_key
from weaver_shared.twin_folder import twin_folder

SWITCH_INTERVAL = 2e-4  # s; physics must not keep the buses' threads waiting for Python's usual 5 ms
WARMING_TICKS = 20
"""The first one waits for compiled kernels."""
SETTINGS = ServoSettings(answer_margin=0.05, watchdog=0.5)
"""A busy computer delivers late; a cycle ends as soon as the last servo has answered all the same."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    robot_key(options.robot_id, "")
    folder = Path(options.folder) if options.folder else twin_folder(options.robot_id)
    if options.task == "faults":
        return _list(as_json=options.json)
    if options.task == "inject":
        done = ask(folder / "faults", options.fault, options.target, options.value, ending=options.end)
        print(json.dumps({"fault": options.fault, "target": options.target, "done": done}) if options.json else done)
        return 0
    return _run(options, folder)


def _run(options: argparse.Namespace, folder: Path) -> int:
    robot = load_robot(options.robot)
    world = make_world(options.world, options.seed)
    ended = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: ended.set())
    sys.setswitchinterval(SWITCH_INTERVAL)
    folder.mkdir(mode=0o700, exist_ok=True)
    config = twin_wiring(robot, folder, settings=SETTINGS, clock=folder / "time", cameras=options.cameras)
    bus = ZenohBus(connect=options.connect.split(",") if options.connect else [])
    with closing(bus), closing(SimulatedBody(robot, world, options.seed)) as body:
        time = TwinTime(folder / "time")
        with (
            closing(RealTimeTwin(Wiring(config, robot), body, time, seed=options.seed)) as twin,
            closing(FaultDesk(folder / "faults", _devices(twin), twin.lock)),
        ):
            for _ in range(WARMING_TICKS):
                twin.tick()
            # The wiring is there when all that it names is, and answers in time.
            (folder / "wiring.toml").write_text(wiring_file(config))
            bus.announce(options.robot_id, "twin")
            run_paced(
                lambda: _tick(twin, bus, options.robot_id),
                Pacer(MonotonicClock(), period=1.0 / CONTROL_RATE),
                ended.is_set,
            )
        (folder / "wiring.toml").unlink()
    return 0


def _tick(twin: RealTimeTwin, bus: ZenohBus, robot_id: str) -> None:
    stamp_ns = twin.tick()
    if twin.body.camera_due():
        bus.publish(robot_id, topics.SCENE, replace(twin.body.scene_state(), stamp_ns=stamp_ns))
    if stamp_ns // 10_000_000 % 2 == 0:
        bus.publish(robot_id, topics.TRUTH, replace(twin.body.truth(), stamp_ns=stamp_ns))


def _devices(twin: RealTimeTwin) -> Devices:
    def plug(name: str, there: bool) -> None:
        terminal = twin.terminals[name]
        # Its thread may be waiting for the lock that is held here.
        threading.Thread(target=terminal.plug_in if there else terminal.unplug, daemon=True).start()

    return Devices(
        joints=twin.wiring.robot.joint_names,
        servos=twin.servos.servos,
        buses=twin.servos.buses,
        sensors=twin.sensors,
        now_ns=twin.time.now_ns,
        plug=plug,
    )


def _list(*, as_json: bool) -> int:
    faults = [
        {"fault": fault.name, "what": fault.what, "target": fault.target, "usual": fault.usual, "ends": bool(fault.end)}
        for fault in FAULTS.values()
    ]
    if as_json:
        print(json.dumps({"faults": faults}))
        return 0
    for fault in faults:
        print(f"{fault['fault']:16} {fault['target']:6} {fault['what']}")
    return 0


def _parser() -> argparse.ArgumentParser:
    result = argparse.ArgumentParser(
        prog="weaver twin", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    tasks = result.add_subparsers(dest="task", required=True, metavar="TASK")
    run = tasks.add_parser("run", help="serve the emulated robot in real time")
    run.add_argument("--robot", default="weaver", help="robot description: a shipped name or a TOML file")
    run.add_argument("--world", default="testbed", help="flat, testbed, outdoor, stairs, wall or pen")
    run.add_argument("--seed", type=int, default=1, help="seed of the world and of all sensor noise")
    run.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    run.add_argument("--cameras", action="store_true", help="its pictures come from GigE Vision cameras")
    inject = tasks.add_parser("inject", help="make something go wrong with a running one")
    inject.add_argument("fault", metavar="FAULT", help=f"one of {', '.join(FAULTS)}")
    inject.add_argument("target", nargs="?", default="", help="joint (AR_yaw) or bus (right) that it happens to")
    inject.add_argument("--value", type=float, help="how much, in the unit that `weaver twin faults` tells")
    inject.add_argument("--end", action="store_true", help="let it end")
    faults = tasks.add_parser("faults", help="list what can go wrong")
    for task in (run, inject, faults):
        task.add_argument("--robot-id", default="sim-1", help="name on the bus, unique per robot")
        task.add_argument("--folder", help="where its ports, wiring and time are (default: one per user and robot)")
    for task in (inject, faults):
        task.add_argument("--json", action="store_true", help="print one JSON object")
    return result
