"""Straight ahead over a world that rises and falls, by the robot's own senses, judged by truth."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sim_agent.study.posture import rise
from sim_agent.study.result import Result
from sim_agent.study.rig import DT, Rig
from sim_agent.study.speeds import pace_of, parameters_for
from sim_agent.study.watch import Watch
from sim_agent.worlds import make_world
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import yaw_of

Array = NDArray[np.float64]

CAUTION = 0.7
"""Of the frequency for level ground."""
BEYOND = 0.4  # m behind the last rise, where the course ends
ABOVE = 0.03  # m that feet swing above the highest step
SLOWEST = 0.35
"""Share of the asked speed below which the robot is stuck."""
HEADING_GAIN = 0.8  # 1/s, keeps the course by truth: the study is about legs, not about odometry
PATH_GAIN = 0.6  # 1/m
LARGEST_TURN = 0.15  # rad/s

STEPS = {"incline10": 0.05, "incline20": 0.07, "stairs6": 0.06}
"""Worlds, and by how much (m) the ground rises under one stride at most."""


def climb(robot: RobotDescription, world_name: str, gait: str, seed: int) -> Result:
    """Stand up and walk along x to behind the last fall."""
    rig = Rig(robot, make_world(world_name, seed), seed)
    try:
        return _climb(rig, gait)
    finally:
        rig.close()


def begin_climb(rig: Rig, gait: str) -> float:
    """Stand up, careful and with high feet; returns the speed to walk at, m/s, or 0 if it does not stand."""
    rig.parameters = _high_and_slow(rig.robot, gait, STEPS[rig.world.name])
    pace = pace_of(rig.robot, gait, "forward", rig.parameters)
    rig.parameters = replace(rig.parameters, stride_frequency=pace.frequency)
    return float(pace.velocity[0]) if rise(rig, gait) else 0.0


def climbing_order(rig: Rig, speed: float) -> Array:
    """Velocity (3,) that keeps the robot on the x axis."""
    pose = rig.truth()
    turn = HEADING_GAIN * (float(np.arctan(-PATH_GAIN * pose.position[1])) - yaw_of(pose.rotation))
    return np.array([speed, 0.0, np.clip(turn, -LARGEST_TURN, LARGEST_TURN)])


def _high_and_slow(robot: RobotDescription, gait: str, step: float) -> GaitParameters:
    usual = parameters_for(robot, gait)
    highest = min(robot.adaptation.stride_height.upper, robot.locomotion.height_bounds[1])
    height = max(usual.stride_height, min(step + ABOVE, highest))
    return replace(usual, stride_frequency=CAUTION * usual.stride_frequency, stride_height=height)


def _climb(rig: Rig, gait: str) -> Result:
    robot, started = rig.robot, time.thread_time()
    course = max(float(box.centre[0] + box.half[0]) for box in rig.world.boxes) + BEYOND
    speed = begin_climb(rig, gait)
    stood, watch, x = speed > 0.0, Watch(), 0.0
    begun, rig.torque_share = rig.seconds, 0.0
    longest = course / (SLOWEST * speed) if stood else 0.0
    while x < course and rig.seconds - begun < longest:
        rig.step(gait=gait, velocity=climbing_order(rig, speed))
        x = float(rig.truth().position[0])
        if not watch.look(rig):
            break
    seconds = max(rig.seconds - begun, DT)
    static = stood and robot.gait(gait).fewest_standing >= 3
    return Result(
        robot=robot.name,
        gait=gait,
        world=rig.world.name,
        manoeuvre="over" if x >= course else f"stuck at {x:.1f} of {course:.1f} m",
        stood=stood,
        fell=watch.fell,
        sat=None,
        belly_on_ground=None,
        asked=speed,
        achieved=x / seconds if x >= course else 0.0,
        static_margin_mm=1e3 * watch.static_margin if static else None,
        energy_margin_mm=1e3 * watch.energy_margin if static else None,
        largest_tilt_deg=float(np.rad2deg(watch.tilt)),
        torque_share=rig.torque_share,
        touches=watch.touches,
        seconds=seconds,
        real_time_factor=rig.seconds / (time.thread_time() - started),
    )
