"""`weaver gait`: foot and joint trajectories of a gait as CSV."""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from math import isfinite
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc import robots as openshc_robots
from robot_agent.locomotion.openshc import step_cycle
from robot_agent.locomotion.openshc import table as openshc_table
from robot_agent.locomotion.trajectory import kinematic_gait
from robot_agent.locomotion.trajectory_table import columns, rows
from weaver_shared.errors import ConfigurationError, InputError, ResourceError
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot, robot_names

STIFFNESS = 2500.0
COMPATIBLE = "openshc-0.5.11"


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.ticks < 1:
        raise InputError(f"--ticks {options.ticks} is not valid; use a whole number from 1 up")
    for name, value in (("--frequency", options.frequency), ("--height", options.height), ("--dt", options.dt)):
        if not (isfinite(value) and value > 0.0):
            raise InputError(f"{name} {value} is not valid; use a number above zero")
    velocity = _velocity(options.velocity)
    if options.compat:
        return _compatible(options, velocity)
    robot = load_robot(options.robot)
    gait = robot.gait(options.gait)
    parameters = GaitParameters(
        stamp_ns=0,
        virtual_stiffness=STIFFNESS,
        stride_frequency=options.frequency,
        stride_height=options.height,
        confidence=1.0,
    )
    ticks = kinematic_gait(
        robot, gait=gait.name, velocity=velocity, ticks=options.ticks, parameters=parameters, dt=options.dt
    )
    with _opened(options.csv) as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns(robot.joints_per_leg))
        writer.writerows(rows(robot, gait, ticks, parameters, options.dt))
    return 0


def _compatible(options: argparse.Namespace, velocity: NDArray[np.float64]) -> int:
    """The trajectories of OpenSHC itself, its own gait timing, limits and solver included."""
    if options.compat != COMPATIBLE:
        raise ConfigurationError(f"--compat {options.compat!r} is unknown; known is {COMPATIBLE}")
    robot = openshc_robots.robot_of(options.robot)
    step_cycle.StepCycle.of(options.gait, robot.step_frequency, robot.dt)
    with _opened(options.csv) as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns(robot.joints))
        writer.writerows(openshc_table.rows(robot, options.gait, velocity, options.ticks))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver gait",
        description="Foot and joint trajectories of a gait on flat ground, one row per tick and leg. The robot stands "
        "for five ticks; the velocity is given once before tick 6. Units: m, rad, s, N.",
    )
    parser.add_argument("--robot", default="weaver", help=f"name ({', '.join(robot_names())}) or .toml file")
    parser.add_argument("--gait", default="tripod", help="one of the robot's gaits")
    parser.add_argument("--velocity", default="0.1,0,0", help="vx,vy,wz of the body: m/s, m/s, rad/s")
    parser.add_argument("--ticks", type=int, default=400, help="number of control ticks")
    parser.add_argument("--frequency", type=float, default=1.0, help="strides per second, Hz")
    parser.add_argument("--height", type=float, default=0.05, help="how high a foot swings, m")
    parser.add_argument("--dt", type=float, default=0.01, help="length of a tick, s")
    parser.add_argument(
        "--compat",
        metavar="VERSION",
        help=f"{COMPATIBLE}: reproduce OpenSHC for --robot {', '.join(openshc_robots.ROBOTS)} and --gait "
        f"{', '.join(step_cycle.GAITS)}; --velocity is then its throttle, -1..1, and tick and frequency are its own",
    )
    parser.add_argument("--csv", default="-", metavar="FILE", help="where to write; - is the standard output")
    return parser


def _velocity(text: str) -> NDArray[np.float64]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 3 or not all(isfinite(number) for number in numbers):
        raise InputError(f"--velocity {text!r} is not valid; use three numbers vx,vy,wz in m/s, m/s and rad/s")
    return np.array(numbers)


@contextmanager
def _opened(target: str) -> Iterator[TextIO]:
    if target == "-":
        yield sys.stdout
        return
    try:
        with open(target, "w", encoding="utf-8", newline="") as stream:
            yield stream
    except OSError as error:
        raise ResourceError(f"{target} can not be written: {error.strerror}") from error
