"""`weaver import-openshc`: OpenSHC's files as a robot description of ours, and back."""

from __future__ import annotations

import argparse
import json
import sys
from math import isfinite
from pathlib import Path

import yaml

from robot_agent.locomotion.openshc.description import configuration_from, description_of
from robot_agent.locomotion.openshc.reading import read_configuration, sections_of
from robot_agent.locomotion.openshc.toml import toml_of
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.robots import load_robot
from weaver_shared.robots.catalogue import robot_of

NOTE = """# Imported from OpenSHC's {source}.
# Assumed, for OpenSHC does not know them: mass, body, servos, imu, power and foot_radius; see --mass.
# [openshc] keeps what else was found, for the way back.
"""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.mass is not None and not (isfinite(options.mass) and options.mass > 0.0):
        raise InputError(f"--mass {options.mass} is not valid; use kilograms above zero")
    if options.export:
        if len(options.files) != 1:
            raise InputError(f"--export takes one .toml file; {len(options.files)} were found")
        text = _exported(options.files[0], options.output)
    else:
        text = _imported(options.files, options.mass)
    _write(text, options.output)
    return 0


def _imported(files: list[str], mass: float | None) -> str:
    configuration = read_configuration([Path(name) for name in files])
    text = NOTE.format(source=", ".join(Path(name).name for name in files)) + toml_of(
        description_of(configuration, mass=mass)
    )
    robot_of(text, files[0])  # what is written can be read
    return text


def _exported(file: str, output: str) -> str:
    sections = sections_of(configuration_from(load_robot(file)))
    if output.endswith(".json"):
        return json.dumps(sections, indent=1) + "\n"
    text: str = yaml.safe_dump(sections, sort_keys=False)
    return text


def _write(text: str, output: str) -> None:
    if output == "-":
        sys.stdout.write(text)
        return
    try:
        Path(output).write_text(text, encoding="utf-8")
    except OSError as error:
        raise ResourceError(f"{output} can not be written: {error.strerror}") from error


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver import-openshc",
        description="Make a robot description (.toml) of OpenSHC's parameters: the robot's YAML with its gait.yaml and "
        "auto_pose.yaml, or one file with all of them, YAML or JSON. The result is a --robot for every command.",
    )
    parser.add_argument("files", nargs="+", metavar="FILE", help="OpenSHC's files; with --export a description")
    parser.add_argument(
        "--export", action="store_true", help="the other way: OpenSHC's parameters of an imported robot"
    )
    parser.add_argument("--mass", type=float, metavar="KG", help="of the whole robot, kg; else in proportion to Bullet")
    parser.add_argument("--output", default="-", metavar="FILE", help="where to write; - is the standard output")
    return parser
