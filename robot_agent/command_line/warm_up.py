"""`weaver warm-up`: compiles the numerical kernels once, so that no loop ever waits for a compiler."""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib.metadata import entry_points

GROUP = "weaver.kernels"
MOST = 4
"""Stages at a time; a compiler takes up to 500 MB."""


def main(arguments: list[str]) -> int:
    argparse.ArgumentParser(prog="weaver warm-up", description=__doc__).parse_args(arguments)
    names = sorted(entry.name for entry in entry_points(group=GROUP))
    workers = min(MOST, len(names), os.cpu_count() or 1)
    with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        compiling = {pool.submit(compile_stage, name): name for name in names}
        for number, done in enumerate(as_completed(compiling), start=1):
            print(f"[{number}/{len(names)}] {compiling[done]} {done.result():.0f} s", file=sys.stderr, flush=True)
    return 0


def compile_stage(name: str) -> float:
    """Compile one stage's kernels; s that it took."""
    started = time.monotonic()
    (entry,) = entry_points(group=GROUP, name=name)
    entry.load()()
    return time.monotonic() - started
