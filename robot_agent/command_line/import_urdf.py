"""`weaver import-urdf`: a legged robot's URDF as a robot description."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from robot_agent.locomotion.openshc.toml import toml_of
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.robots.catalogue import robot_of
from weaver_shared.robots.urdf import ImportedRobot, robot_of_urdf


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    path = Path(options.file)
    try:
        document = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path} can not be read: {error.strerror}") from error
    imported = robot_of_urdf(document, path.name)
    text = _comments(path.name, imported) + toml_of(imported.tables)
    robot = robot_of(text, path.name)  # what is written can be read
    if options.out != "-":
        _write(text, options.out)
    elif not options.json:
        sys.stdout.write(text)
    if options.json:
        print(
            json.dumps(
                {
                    "robot": robot.name,
                    "out": options.out,
                    "legs": list(robot.leg_names),
                    "joints_per_leg": robot.joints_per_leg,
                    "mass_kg": robot.mass,
                    "clearance_m": robot.clearance,
                    "deviation_m": imported.deviation,
                    "joints": [
                        {"name": one.name, "urdf": one.urdf_name, "sign": one.sign, "offset_rad": one.offset}
                        for one in imported.joints
                    ],
                    "notes": list(imported.notes),
                }
            )
        )
    return 0


def _comments(source: str, imported: ImportedRobot) -> str:
    """What a reader of the description has to know."""
    lines = [f"Imported from {source}; feet are within {imported.deviation:.1e} m of the URDF's."]
    lines += [f"{note[0].upper()}{note[1:]}." for note in imported.notes]
    lines += [
        f"{one.name} = {'-' if one.sign < 0.0 else ''}{one.urdf_name}{f' {one.offset:+.6g} rad' if one.offset else ''}"
        for one in imported.joints
        if one.sign < 0.0 or one.offset
    ]
    return "".join(f"# {line}\n" for line in lines) + "\n"


def _write(text: str, out: str) -> None:
    try:
        Path(out).write_text(text, encoding="utf-8")
    except OSError as error:
        raise ResourceError(f"{out} can not be written: {error.strerror}") from error


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver import-urdf",
        description="Make a robot description (.toml) of a URDF with 3 to 8 like legs of 3 to 6 revolute joints. "
        "Masses (kg), limits (rad, rad/s, N m) and lengths (m) are the URDF's, the stance is a guess. The result is a "
        "--robot for every command.",
    )
    parser.add_argument("file", metavar="FILE", help="the URDF; of a xacro file, what xacro makes of it")
    parser.add_argument("--out", default="-", metavar="FILE", help="where to write; - is the standard output")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the description")
    return parser
