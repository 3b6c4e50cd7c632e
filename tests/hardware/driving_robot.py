"""A robot's program: swings all joints until somebody ends it; says first whether servos were holding or limp."""

from __future__ import annotations

import sys
from contextlib import closing
from pathlib import Path

import numpy as np
from hardware_bodies import order

from robot_agent.hardware.opening import open_body
from robot_agent.hardware.wiring import Wiring, load_wiring
from sim_agent.model import sitting_joints
from weaver_shared.robots import load_robot

SWING = 0.4  # rad
PERIOD = 100  # ticks


def main() -> None:
    config = load_wiring(Path(sys.argv[1]))
    robot = load_robot(config.robot)
    middle = sitting_joints(robot)
    with closing(open_body(Wiring(config, robot))) as body:
        body.prepare()
        print("holding" if body.holding else "limp", flush=True)
        tick = 0
        while True:
            body.wait_next()
            body.write(order(middle + SWING * np.sin(2.0 * np.pi * tick / PERIOD)))
            tick += 1


if __name__ == "__main__":
    main()
