"""`weaver bench tick`: how long one locomotion tick takes, in thread CPU time."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable

import numpy as np

from robot_agent.locomotion.warm_up import walking_tick
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.robots import RobotDescription, load_robot

WARM_UP_TICKS = 300


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="weaver bench tick",
        description="Thread CPU time of one walking tick in microseconds: five- and three-joint legs, without ground "
        "contact (walk) and with foot forces, load sharing, impedance and servo lead (admittance).",
    )
    parser.add_argument("--robot", default="weaver", help="robot with five-joint legs")
    parser.add_argument("--ticks", type=int, default=4000, help="ticks measured for each figure")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    figures = measure(load_robot(options.robot), options.ticks)
    if options.json:
        print(json.dumps({"tick_us": figures}))
        return 0
    for name, figure in figures.items():
        print(f"{name:24} median {figure['median']:7.1f} us   p99 {figure['p99']:7.1f} us")
    return 0


def measure(robot: RobotDescription, ticks: int) -> dict[str, dict[str, float]]:
    """Median and 99th percentile, us, by case."""
    bare = LocomotionConfig(feel_ground=False, compensate_servos=False)
    full = LocomotionConfig()
    three = with_three_joints(robot)
    cases = {
        "five_joint_walk": (robot, bare),
        "five_joint_admittance": (robot, full),
        "three_joint_walk": (three, bare),
        "three_joint_admittance": (three, full),
    }
    return {
        name: _figures(walking_tick(which, config, frequency=1.0), ticks) for name, (which, config) in cases.items()
    }


def with_three_joints(robot: RobotDescription) -> RobotDescription:
    """The same robot on yaw-pitch-pitch legs of the same length, as OpenSHC's default robot has them."""
    yaw, roll, femur, tibia, tarsus = robot.joints
    quarter = 0.5 * float(np.pi)
    first = yaw.model_copy(
        update={"theta": 0.0, "r": roll.d, "alpha": -quarter, "mass": yaw.mass + roll.mass, "lower": -1.2}
    )
    second = femur.model_copy(update={"theta": 0.0, "lower": -1.75, "upper": 1.4})
    last = tibia.model_copy(update={"r": tibia.r + tarsus.r, "mass": tibia.mass + tarsus.mass, "lower": -0.3})
    return robot.model_copy(update={"joints": (first, second, last), "name": f"{robot.name} on three joints"})


def _figures(tick: Callable[[], None], ticks: int) -> dict[str, float]:
    for _ in range(WARM_UP_TICKS):
        tick()
    times = np.empty(ticks)
    for index in range(ticks):
        begin = time.thread_time_ns()
        tick()
        times[index] = time.thread_time_ns() - begin
    median, p99 = np.percentile(times * 1e-3, [50.0, 99.0])
    return {"median": round(float(median), 2), "p99": round(float(p99), 2)}
