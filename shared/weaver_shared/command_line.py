"""The `weaver` command: finds the subcommands the packages register and runs one."""

from __future__ import annotations

import os
import sys
from importlib.metadata import EntryPoint, entry_points

from weaver_shared.errors import WeaverError

GROUP = "weaver.commands"

# One thread for linear algebra: our matrices are small, and waiting threads spin on cores that other loops need.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")


def main(arguments: list[str] | None = None) -> int:
    """Run `weaver SUBCOMMAND ...`; returns the exit code. Bad input ends in one sentence on stderr and 2."""
    arguments = sys.argv[1:] if arguments is None else arguments
    commands = _registered(GROUP)
    if not arguments or arguments[0] in ("-h", "--help"):
        print("usage: weaver COMMAND [options]\n\ncommands:")
        for name in sorted(commands):
            print(f"  {name}")
        print("\n`weaver COMMAND --help` tells its options with their units.")
        return 0
    return run(commands, arguments, "command")


def run(commands: dict[str, EntryPoint], arguments: list[str], what: str) -> int:
    name, *rest = arguments
    if name not in commands:
        print(f"weaver: {what} {name!r} is unknown; known are {', '.join(sorted(commands))}", file=sys.stderr)
        return 2
    try:
        return int(commands[name].load()(rest) or 0)
    except WeaverError as error:
        print(f"weaver {name}: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        return 0


def _registered(group: str) -> dict[str, EntryPoint]:
    return {entry.name: entry for entry in entry_points(group=group)}


def bench(arguments: list[str]) -> int:
    """`weaver bench NAME`: the registered measurements."""
    benches = _registered("weaver.benches")
    if not arguments or arguments[0] in ("-h", "--help"):
        print(f"usage: weaver bench NAME [--json]\n\nnames: {', '.join(sorted(benches))}")
        return 0
    return run(benches, arguments, "bench")


def study(arguments: list[str]) -> int:
    """`weaver study NAME`: the registered experiments."""
    studies = _registered("weaver.studies")
    if not arguments or arguments[0] in ("-h", "--help"):
        print(f"usage: weaver study NAME [--json]\n\nnames: {', '.join(sorted(studies))}")
        return 0
    return run(studies, arguments, "study")


if __name__ == "__main__":
    sys.exit(main())
