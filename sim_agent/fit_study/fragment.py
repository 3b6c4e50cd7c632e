"""The fitted settings as the [adaptation] section of a robot description."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.errors import InputError


def write_fragment(path: Path, adaptation: AdaptationConfig, robot: str) -> None:
    """Write what differs from the defaults, so that the file is the whole section. Raises InputError if it can not."""
    lines = [
        f"# Fitted for {robot} by `weaver study fit`. In a robot's own TOML file this is the section [adaptation].",
        "[adaptation]",
        *(f"{name} = {_toml(value)}" for name, value in adaptation.model_dump(exclude_defaults=True).items()),
    ]
    try:
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path} can not be written: {error.strerror}") from error


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return f"{float(value)!r}"
