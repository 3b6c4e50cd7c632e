"""`weaver warm-up`: compiles the numerical kernels once, so that no loop ever waits for a compiler."""

from __future__ import annotations

import argparse
import sys
import time
from importlib.metadata import entry_points

GROUP = "weaver.kernels"


def main(arguments: list[str]) -> int:
    argparse.ArgumentParser(prog="weaver warm-up", description=__doc__).parse_args(arguments)
    kernels = sorted(entry_points(group=GROUP), key=lambda entry: entry.value)
    for number, entry in enumerate(kernels, start=1):
        started = time.monotonic()
        print(f"[{number}/{len(kernels)}] {entry.name} ", end="", file=sys.stderr, flush=True)
        entry.load()()
        print(f"{time.monotonic() - started:.0f} s", file=sys.stderr, flush=True)
    return 0
