"""`weaver gait`: foot and joint trajectories of a gait as CSV."""

from __future__ import annotations

import argparse
import csv
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from math import isfinite
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from robot_agent.command_line import gait_of_openshc, gait_plot
from robot_agent.locomotion.trajectory import kinematic_gait
from robot_agent.locomotion.trajectory_table import columns, rows
from weaver_shared.errors import ConfigurationError, InputError, ResourceError
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot, robot_names

STIFFNESS = 2500.0
TICKS = 400
COMPATIBLE = "openshc-0.5.11"


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(_joined(arguments))
    if options.ticks is not None and options.ticks < 1:
        raise InputError(f"--ticks {options.ticks} is not valid; use a whole number from 1 up")
    for name, value in (("--frequency", options.frequency), ("--height", options.height), ("--dt", options.dt)):
        if not (isfinite(value) and value > 0.0):
            raise InputError(f"{name} {value} is not valid; use a number above zero")
    velocity = _velocity(options.velocity)
    if options.compat and options.plot:
        raise InputError("--plot shows the gaits of this program; leave --compat out")
    if options.compat:
        if options.compat != COMPATIBLE:
            raise ConfigurationError(f"--compat {options.compat!r} is unknown; known is {COMPATIBLE}")
        with _opened(options.csv or "-") as legs, _opened(options.body or os.devnull) as body:
            gait_of_openshc.write(options, velocity, legs, body)
        return 0
    gait_of_openshc.refuse(options)
    robot = load_robot(options.robot)
    gait = robot.gait(options.gait or "tripod")
    parameters = GaitParameters(
        stamp_ns=0,
        virtual_stiffness=STIFFNESS,
        stride_frequency=options.frequency,
        stride_height=options.height,
        confidence=1.0,
    )
    ticks = kinematic_gait(
        robot, gait=gait.name, velocity=velocity, ticks=options.ticks or TICKS, parameters=parameters, dt=options.dt
    )
    if options.plot:
        recorded = list(ticks)
        gait_plot.write(options.plot, robot, gait, recorded, parameters, options.dt)
        if options.csv is None:
            return 0
        ticks = iter(recorded)
    with _opened(options.csv or "-") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(columns(robot.joints_per_leg))
        writer.writerows(rows(robot, gait, ticks, parameters, options.dt))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver gait",
        description="Foot and joint trajectories of a gait on flat ground, one row per tick and leg. The robot stands "
        "for five ticks; the velocity is given once before tick 6. Units: m, rad, s, N.",
    )
    parser.add_argument("--robot", default="weaver", help=f"name ({', '.join(robot_names())}) or .toml file")
    parser.add_argument("--gait", help="one of the robot's gaits; tripod unless told, or OpenSHC's own choice")
    parser.add_argument("--velocity", default="0.1,0,0", help="vx,vy,wz of the body: m/s, m/s, rad/s")
    parser.add_argument(
        "--ticks",
        type=int,
        help=f"number of control ticks, {TICKS} unless told; with --stop-after until ten ticks after the stop",
    )
    parser.add_argument("--frequency", type=float, default=1.0, help="strides per second, Hz")
    parser.add_argument("--height", type=float, default=0.05, help="how high a foot swings, m")
    parser.add_argument("--dt", type=float, default=0.01, help="length of a tick, s")
    gait_of_openshc.add_options(parser, COMPATIBLE)
    parser.add_argument(
        "--csv",
        nargs="?",
        const="-",
        metavar="FILE",
        help="where to write; the standard output unless told, or nowhere with --plot",
    )
    parser.add_argument(
        "--plot",
        metavar="FILE",
        help="draw workspaces, walkspaces, speed limits, the foot's path and the gait's timing (.png, .svg or .pdf)",
    )
    return parser


def _joined(arguments: list[str]) -> list[str]:
    """`--velocity -0.6,0,0` as one word, for argparse takes the second for an option."""
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1] == "--velocity":
            joined[-1] = f"--velocity={argument}"
        else:
            joined.append(argument)
    return joined


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
