"""`weaver bench tick`: how long one locomotion tick takes, in thread CPU time.

A tick is what the control loop does: it makes the walker's input, steps the walker and reads the servo targets. Times
on a shared machine mean little by themselves, so a fixed piece of arithmetic is timed among the ticks, and every case
is also given as a multiple of that.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable

import numpy as np

from robot_agent.locomotion.ideal_walk import IdealWalk
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.yardstick import yardstick
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.robots import load_robot

WARM_UP_TICKS = 300
YARDSTICK_EVERY = 10
"""Ticks."""
YARDSTICK_TURNS = 1000
STRIDE = 0.25
"""Of the robot's largest speed, walked forwards; a fifth of that sideways."""
FULL = PosingOrder(manual=(0.005, 0.0, 0.005, 0.01, 0.01, 0.0), automatic=True, levelling=True)
OPENSHC_US = {
    "bullet_walk": 35.5,
    "bullet_admittance": 92.0,
    "three_joint_walk": 29.4,
    "three_joint_posing": 60.9,
}
"""Medians of OpenSHC 0.5.11 in C++ for the same robots and stages, measured by us on a 2.25 GHz AMD EPYC."""


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(
        prog="weaver bench tick",
        description="Thread CPU time of one walking tick in microseconds: without ground contact (walk); with foot "
        "forces, load sharing, impedance and servo lead (admittance); and with the body posed by hand, with the gait "
        "and by the IMU as well (posing). Five-joint legs with a closed form, OpenSHC's Bullet with five-joint legs "
        "that have none, and OpenSHC's three-joint robot.",
    )
    parser.add_argument("--robot", default="weaver", help="robot with five-joint legs")
    parser.add_argument("--ticks", type=int, default=4000, help="ticks measured for each figure")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    figures = measure(options.robot, options.ticks)
    if options.json:
        print(json.dumps({"tick_us": figures, "openshc_us": OPENSHC_US}))
        return 0
    print("case                       median       p99      yardsticks   OpenSHC's median")
    for name, figure in figures.items():
        theirs = f"{OPENSHC_US[name]:12.1f} us" if name in OPENSHC_US else ""
        print(f"{name:22} {figure['median']:7.1f} us {figure['p99']:7.1f} us {figure['yardsticks']:10.2f} {theirs}")
    return 0


def measure(five_joints: str, ticks: int) -> dict[str, dict[str, float]]:
    """Median and 99th percentile, us, the median in yardsticks, and what the yardstick itself took, by case."""
    bare = LocomotionConfig(feel_ground=False, compensate_servos=False)
    stages = {
        "walk": (bare, NO_POSING),
        "admittance": (LocomotionConfig(), NO_POSING),
        "posing": (LocomotionConfig(), FULL),
    }
    robots = {"five_joint": five_joints, "bullet": "bullet_insectoid", "three_joint": "default"}
    figures = {}
    for legs, name in robots.items():
        robot = load_robot(name)
        velocity = STRIDE * robot.locomotion.largest_speed * np.array([1.0, 0.2, 0.5])
        for stage, (config, posing) in stages.items():
            own = {field: getattr(config, field) for field in ("feel_ground", "compensate_servos")}
            settled = robot.locomotion.model_copy(update=own)
            walk = IdealWalk(robot, settled, velocity=velocity, posing=posing)
            figures[f"{legs}_{stage}"] = _figures(walk.replay(WARM_UP_TICKS + ticks), ticks)
    return figures


def _figures(tick: Callable[[], object], ticks: int) -> dict[str, float]:
    for _ in range(WARM_UP_TICKS):
        tick()
    times, fixed = np.empty(ticks), []
    for index in range(ticks):
        times[index] = _time(tick)
        if index % YARDSTICK_EVERY == 0:
            fixed.append(_time(_yardstick))
    median, p99 = np.percentile(times, [50.0, 99.0])
    unit, slow_unit = np.percentile(fixed, [50.0, 99.0])
    return {
        "median": round(float(median), 2),
        "p99": round(float(p99), 2),
        "yardsticks": round(float(median / unit), 3),
        "yardstick": round(float(unit), 2),
        "yardstick_p99": round(float(slow_unit), 2),
    }


def _time(work: Callable[[], object]) -> float:
    """Thread CPU time of a call, us."""
    begin = time.thread_time_ns()
    work()
    return (time.thread_time_ns() - begin) * 1e-3


def _yardstick() -> None:
    yardstick(YARDSTICK_TURNS)
