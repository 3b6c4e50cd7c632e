"""Nested tables as TOML text: what Python reads with `tomllib`, it has nothing to write."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any


def toml_of(tables: Mapping[str, Any]) -> str:
    """Mappings become tables two levels deep and inline ones below, lists of mappings arrays of tables."""
    return "\n".join(_lines("", tables, 0)) + "\n"


def _lines(name: str, table: Mapping[str, Any], depth: int) -> Iterator[str]:
    plain = {key: value for key, value in table.items() if not _is_table(value, depth)}
    if name and (plain or not table):
        yield f"\n[{name}]"
    for key, value in plain.items():
        yield f"{_key(key)} = {_value(value)}"
    for key, value in table.items():
        path = f"{name}.{_key(key)}" if name else _key(key)
        if key in plain:
            continue
        if isinstance(value, Mapping):
            yield from _lines(path, value, depth + 1)
            continue
        for entry in value:
            yield f"\n[[{path}]]"
            yield from (f"{_key(inner)} = {_value(part)}" for inner, part in entry.items())


def _is_table(value: Any, depth: int) -> bool:
    if isinstance(value, Mapping):
        return depth < 2
    return depth == 0 and isinstance(value, list) and bool(value) and all(isinstance(one, Mapping) for one in value)


def _key(key: str) -> str:
    return key if key.replace("_", "").replace("-", "").isalnum() and key.isascii() else json.dumps(key)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):
        return (
            "{ " + ", ".join(f"{_key(key)} = {_value(part)}" for key, part in value.items()) + " }" if value else "{}"
        )
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(part) for part in value) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
