"""`weaver warm-up`: compiles the numerical kernels once, so that no loop ever waits for a compiler."""

from __future__ import annotations

import argparse
import importlib
import sys
import time

STAGES = (
    "robot_agent.kinematics",
    "robot_agent.locomotion",
    "robot_agent.odometry",
    "robot_agent.perception",
    "robot_agent.mapping",
)


def main(arguments: list[str]) -> int:
    argparse.ArgumentParser(prog="weaver warm-up", description=__doc__).parse_args(arguments)
    for number, stage in enumerate(STAGES, start=1):
        started = time.monotonic()
        print(f"[{number}/{len(STAGES)}] {stage} ", end="", file=sys.stderr, flush=True)
        module = importlib.import_module(stage)
        if hasattr(module, "warm_up"):
            module.warm_up()
        print(f"{time.monotonic() - started:.0f} s", file=sys.stderr, flush=True)
    return 0
