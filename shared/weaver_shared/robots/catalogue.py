"""Robots by name or file, checked as a whole."""

from __future__ import annotations

import tomllib
from importlib import resources
from pathlib import Path

from pydantic import ValidationError

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots.description import RobotDescription
from weaver_shared.robots.plausibility import check


def robot_names() -> tuple[str, ...]:
    folder = resources.files("weaver_shared.robots")
    return tuple(sorted(entry.name[:-5] for entry in folder.iterdir() if entry.name.endswith(".toml")))


def load_robot(name_or_path: str = "weaver") -> RobotDescription:
    """A shipped robot by name, or one's own TOML file by path.

    Raises ConfigurationError that names the key, what was found and what is valid.
    """
    if name_or_path in robot_names():
        text = (resources.files("weaver_shared.robots") / f"{name_or_path}.toml").read_text()
    elif Path(name_or_path).is_file():
        text = Path(name_or_path).read_text()
    else:
        known = ", ".join(robot_names())
        raise ConfigurationError(f"robot {name_or_path!r} is unknown; known are {known}, or give a .toml file")
    return robot_of(text, name_or_path)


def robot_of(text: str, source: str) -> RobotDescription:
    """The robot that a TOML text describes; `source` says in errors where it came from."""
    try:
        robot = RobotDescription.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise ConfigurationError(f"robot {source!r} is not valid TOML: {error}") from error
    except ValidationError as error:
        raise ConfigurationError(f"robot {source!r}: {_sentence(error)}") from error
    check(robot.model_copy())  # a copy, for changed robots are made from ours by copying: nothing may be worked out yet
    return robot


def _sentence(error: ValidationError) -> str:
    first = error.errors()[0]
    if first["type"] == "value_error":
        return str(first["ctx"]["error"])
    where = ".".join(str(part) for part in first["loc"]) or "robot"
    return f"{where}: {first['msg']} (found {first['input']!r:.80})"
