"""The `--compat` form of `weaver gait`: trajectories of OpenSHC itself, with its own timing, limits and solver."""

from __future__ import annotations

import argparse
import csv
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.configuration import Configuration
from robot_agent.locomotion.openshc.description import configuration_from
from robot_agent.locomotion.openshc.reading import read_configuration, with_settings
from robot_agent.locomotion.openshc.run import IDLE_TICKS, run
from robot_agent.locomotion.openshc.script import COMMANDS, Event, events_of
from robot_agent.locomotion.openshc.shipped import ROBOTS, shipped
from robot_agent.locomotion.openshc.table import BODY_COLUMNS, body_row, leg_rows
from robot_agent.locomotion.trajectory_table import columns
from weaver_shared.errors import ConfigurationError, InputError
from weaver_shared.robots import load_robot

OWN = ("stop_after", "script", "settings", "start_up", "body")
FILES = (".yaml", ".yml", ".json")


def add_options(parser: argparse.ArgumentParser, version: str) -> None:
    group = parser.add_argument_group(
        "reproducing OpenSHC",
        "Tick, frequency and swing height are OpenSHC's own; --velocity is in its input mode, a throttle of -1..1 "
        f"unless --set says otherwise. A script has lines of TICK COMMAND VALUES: {'; '.join(_commands())}.",
    )
    group.add_argument(
        "--compat",
        metavar="VERSION",
        help=f"{version}: reproduce OpenSHC for --robot {', '.join(ROBOTS)}, or a robot's own OpenSHC files "
        "(.yaml or .json, separated by commas) or an imported .toml, with one of its gaits",
    )
    group.add_argument("--stop-after", type=int, metavar="TICKS", help="take the velocity back TICKS after giving it")
    group.add_argument("--script", metavar="FILE", help="told instead of --velocity; - is the standard input")
    group.add_argument(
        "--set",
        action="append",
        dest="settings",
        metavar="KEY=VALUE",
        help="an OpenSHC parameter, as step_depth=0.01 or max_rotation.yaw=0.1; may be given several times",
    )
    group.add_argument(
        "--start-up", action="store_true", default=None, help="begin before the start-up, joints at rest"
    )
    group.add_argument("--body", metavar="FILE", help="where to write the body's table too; none unless told")


def _commands() -> list[str]:
    return [f"{name} {takes}" for name, (_, _, takes) in COMMANDS.items()]


def refuse(options: argparse.Namespace) -> None:
    """Options that mean something to OpenSHC alone. Raises InputError."""
    for name in OWN:
        if getattr(options, name) is not None:
            raise InputError(f"--{name.replace('settings', 'set').replace('_', '-')} is of use with --compat only")


def write(options: argparse.Namespace, velocity: NDArray[np.float64], legs: TextIO, body: TextIO) -> None:
    """Rows of every tick and leg to `legs`, and of every tick to `body`."""
    description = _description(options)
    events = _events(options, velocity)
    endless = options.stop_after is not None and options.ticks is None
    ticks = None if endless else options.ticks or 400
    leg_table, body_table = (csv.writer(stream, lineterminator="\n") for stream in (legs, body))
    leg_table.writerow(columns(description.joints_per_leg))
    body_table.writerow(BODY_COLUMNS)
    for tick, controller in run(description, events, ticks=ticks, from_rest=bool(options.start_up)):
        leg_table.writerows(leg_rows(tick, controller))
        body_table.writerow(body_row(tick, controller))


def _description(options: argparse.Namespace) -> Configuration:
    """The robot with its gait and whatever else is set."""
    paths = [Path(part) for part in options.robot.split(",")]
    if options.robot.endswith(".toml"):
        description = configuration_from(load_robot(options.robot))
    else:
        own = all(path.suffix in FILES for path in paths)
        description = read_configuration(paths) if own else shipped(options.robot)
    gait = options.gait
    if gait is not None:
        gait = gait if gait in description.gaits else f"{gait}_gait"
        if gait not in description.gaits:
            known = ", ".join(name.removesuffix("_gait") for name in description.gaits)
            raise ConfigurationError(f"gait {options.gait!r} is not one of {options.robot}'s; known are {known}")
        description = with_settings(description, [f"gait_type={gait}"])
    return with_settings(description, options.settings or ())


def _events(options: argparse.Namespace, velocity: NDArray[np.float64]) -> list[Event]:
    if options.script is not None:
        return events_of(_text(options.script))
    first = IDLE_TICKS + 1
    events = [Event(tick=first, command="velocity", values=tuple(str(part) for part in velocity))]
    if options.start_up:
        events.append(Event(tick=0, command="state", values=("running",)))
    if options.stop_after is not None:
        if options.stop_after < 1:
            raise InputError(f"--stop-after {options.stop_after} is not valid; use a whole number from 1 up")
        events.append(Event(tick=first + options.stop_after, command="velocity", values=("0", "0", "0")))
    return events


def _text(target: str) -> str:
    path = Path("/dev/stdin" if target == "-" else target)
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{target} can not be read: {getattr(error, 'strerror', None) or error}") from error
