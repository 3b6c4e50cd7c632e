"""Writes docs/messages.md from the table of topics and the messages themselves: `python docs/messages_document.py`."""

import dataclasses
import inspect
import re
from pathlib import Path
from typing import Any

from weaver_shared import codec
from weaver_shared.messages import CommandName
from weaver_shared.topics import COMMANDS, QUERIES, ROOT, TOPICS

TARGET = Path(__file__).with_name("messages.md")

HEAD = f"""# Messages
Written by `docs/messages_document.py` from `weaver_shared/topics.py` and `weaver_shared/messages/`; do not edit.

Keys lie under `{ROOT}/{{robot_id}}/`. On the wire a message is the MessagePack list `[schema, kind, field, ...]` with
its fields in the order below (schema {codec.SCHEMA_VERSION}); an array is the list `[dtype, shape, bytes]`,
row-major and little-endian. Another schema is refused with a sentence, never guessed at.

`latest`: a lost sample does not matter, the next one replaces it. `reliable`: who joins late gets the last one.
`logged`: each one counts.

## Topics
| key | message | rate | priority | policy |
|---|---|---|---|---|
"""

COMMANDS_PART = f"""
## Commands
A query to `{COMMANDS.key}` carries a `Command` and is answered with an `Answer`: accepted with what was really applied,
or refused with a reason. The names: {{names}}.

All questions, by their keys: {{queries}}.

A process says that it is alive by the liveliness token `alive/{{{{process}}}}`.

## Fields
"""

FIELD = re.compile(r"^    (?P<name>\w+): (?P<type>[^#=]+?)(?: = [^#]+?)?(?:\s*#\s*(?P<note>.*))?$")


def document() -> str:
    rows = [
        f"| `{topic.key}` | {topic.message.__name__} | {_rate(topic.rate)} | {topic.priority} | {topic.policy} |"
        for topic in sorted(TOPICS, key=lambda topic: topic.key)
    ]
    names = ", ".join(f"`{name}`" for name in CommandName)
    queries = ", ".join(f"`{q.key}` ({q.question.__name__} → {q.answer.__name__})" for q in QUERIES)
    kinds = [_kind(kind) for _, kind in sorted(codec.MESSAGES.items())]
    return HEAD + "\n".join(rows) + "\n" + COMMANDS_PART.format(names=names, queries=queries) + "\n".join(kinds)


def _rate(rate: float) -> str:
    return f"{rate:g} Hz" if rate else "on change"


def _kind(kind: type[Any]) -> str:
    written = {match["name"]: match for match in map(FIELD.match, inspect.getsource(kind).splitlines()) if match}
    summary = "" if (kind.__doc__ or "").startswith(f"{kind.__name__}(") else inspect.cleandoc(kind.__doc__ or "")
    lines = [f"### {kind.__name__}"]
    if summary:
        lines += [summary, ""]
    lines += ["| field | type | meaning |", "|---|---|---|"]
    for field in dataclasses.fields(kind):
        match = written[field.name]
        lines.append(f"| {field.name} | `{match['type']}` | {(match['note'] or '').replace('|', '/')} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    TARGET.write_text(document())
