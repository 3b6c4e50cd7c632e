"""`weaver walk`: one mission of the simulated robot in lock step, headless, with its figures."""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from robot_agent.adaptation import safe_gait
from robot_agent.loops import CONTROL_RATE
from robot_agent.mapping.files import MapSnapshot, load_map, save_map
from robot_agent.recording import Recorder, RecordingWriter
from sim_agent.body import SimulatedBody
from sim_agent.json_figures import without_nan
from sim_agent.lock_step import LockStep, SteppedBody
from sim_agent.mission import begin_mission
from sim_agent.run_log import RunLog
from sim_agent.servo_bus.twin_body import TwinBody
from sim_agent.worlds import World, make_world
from weaver_shared.errors import InputError
from weaver_shared.messages import Waypoint
from weaver_shared.robots import RobotDescription, load_robot

BODIES: dict[str, Callable[[RobotDescription, World, int], SteppedBody]] = {"sim": SimulatedBody, "twin": TwinBody}


def main(arguments: list[str]) -> int:
    options = parser().parse_args(arguments)
    figures = walk(options)
    if options.json:
        print(json.dumps(without_nan(figures)))
    else:
        _print(figures)
    return 0 if figures["reached"] else 1


def walk(options: argparse.Namespace, *, tell_truth: bool = True) -> dict[str, Any]:
    """Stand up, walk to the goal, and report. Raises InputError on a goal that is refused."""
    goal = _goal(options.goal)
    known = load_map(Path(options.known_map)) if options.known_map else None
    robot = load_robot(options.robot_description)
    world = make_world(options.world, options.seed)
    run = LockStep(robot, world, options.seed, tell_truth=tell_truth, body=BODIES[options.robot])
    recording = _Recording(run, Path(options.record)) if options.record else None
    log = RunLog(world=world, mass=robot.mass, dt=1.0 / CONTROL_RATE)
    started = time.monotonic()
    try:
        if known is not None:
            _enter(run, known, options.known_map)
        reached = _mission(run, log, goal, options, recording)
        if options.map:
            _save(run, Path(options.map))
    finally:
        if recording is not None:
            recording.close()
        run.close()
    simulated = run.clock.now_ns() * 1e-9
    wall = time.monotonic() - started
    figures = log.figures()
    if options.against:
        figures["joint_tracking_difference_rms_deg"] = _difference(figures, Path(options.against))
    return {"reached": reached, "digest": log.digest, "real_time_factor": simulated / wall, **figures}


class _Recording:
    """All that the robot says in this run, in one file."""

    def __init__(self, run: LockStep, path: Path) -> None:
        started = datetime.now().astimezone().isoformat(timespec="seconds")
        self._writer = RecordingWriter(path, robot_id=run.robot_id, robot=run.robot, clock=run.clock, started=started)
        self._recorder = Recorder(run.bus, run.robot_id, self._writer)

    def turn(self) -> None:
        self._recorder.turn()

    def close(self) -> None:
        self._recorder.turn()
        self._writer.close()


def _mission(
    run: LockStep, log: RunLog, goal: Waypoint, options: argparse.Namespace, recording: _Recording | None
) -> bool:
    constant = None if options.adapt == "on" else safe_gait(run.robot.adaptation)
    begin_mission(run, (goal,), constant=constant, gait=options.gait, find_way=options.navigate == "auto")
    with tqdm(total=0, unit=" s", disable=not sys.stderr.isatty(), bar_format="{desc}") as bar:
        for tick in range(round(options.timeout * CONTROL_RATE)):
            moment = run.step()
            log.add(moment)
            if recording is not None:
                recording.turn()
            if tick % 100 == 0:
                x, y, _ = moment.walk.state.world_from_body.position
                bar.set_description_str(f"{tick / CONTROL_RATE:.0f} s, at {x:.2f}, {y:.2f} m")
            phase = run.walk.desk.mission(moment.walk.stamp_ns).phase
            if phase == "done":
                return True
            if phase == "paused" or moment.walk.permission.mode == "FAULT":
                return False
    return False


def _enter(run: LockStep, known: MapSnapshot, name: str) -> None:
    run.step()
    terrain_map = run.map()
    if terrain_map is None:
        return
    try:
        terrain_map.restore(known)
    except ValueError as error:
        raise InputError(f"{name}: {error}") from error


def _save(run: LockStep, path: Path) -> None:
    terrain_map = run.map()
    if terrain_map is not None:
        save_map(path, terrain_map.snapshot())


def _difference(figures: dict[str, Any], earlier: Path) -> float:
    """How differently each joint followed its orders in another walk: rms over the joints, degrees."""
    try:
        other = json.loads(earlier.read_text())["joint_tracking_deg"]
        apart = np.subtract(figures.get("joint_tracking_deg", np.nan), other)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{earlier} is not the JSON of a walk of this robot: {error}") from error
    return float(np.sqrt(np.mean(np.square(apart))))


def _goal(text: str) -> Waypoint:
    try:
        x, y = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"goal {text!r} is not a place; give x,y in metres such as 5,0") from None
    if not (math.isfinite(x) and math.isfinite(y)):
        raise InputError(f"goal {text!r} is not a place; x and y must be finite")
    return Waypoint(x=x, y=y)


def _print(figures: dict[str, Any]) -> None:
    for key, value in figures.items():
        print(f"{key}: {json.dumps(without_nan(value))}")


def parser() -> argparse.ArgumentParser:
    result = argparse.ArgumentParser(prog="weaver walk", description=__doc__)
    result.add_argument("--robot", choices=tuple(BODIES), default="sim", help="twin: on emulated servos")
    result.add_argument("--robot-description", default="weaver", help="a shipped robot or a TOML file")
    result.add_argument("--world", default="testbed", help="flat, testbed, outdoor, stairs, wall or pen")
    result.add_argument("--goal", default="5,0", help="x,y in m from the start")
    result.add_argument(
        "--navigate",
        choices=("straight", "auto"),
        default="straight",
        help="auto: around obstacles, by a way found over the map",
    )
    result.add_argument("--adapt", choices=("on", "off"), default="on", help="off: constant, for rough ground")
    result.add_argument("--gait", default="tripod", help="gait of the robot description")
    result.add_argument("--seed", type=int, default=1, help="seed of the world and of all sensor noise")
    result.add_argument("--map", metavar="FILE", help="save the terrain map at the end, .npz; see `weaver map`")
    result.add_argument("--known-map", metavar="FILE", help="begin with a saved map of this place")
    result.add_argument("--record", metavar="FILE", help="record messages and pictures, .mcap; see `weaver odometry`")
    result.add_argument("--timeout", type=float, default=600.0, help="simulated seconds before giving up")
    result.add_argument(
        "--against",
        metavar="FILE",
        help="JSON of another walk, such as one of --robot sim: how differently the joints followed, degrees rms",
    )
    result.add_argument("--json", action="store_true", help="print one JSON object")
    return result
