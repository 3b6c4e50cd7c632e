"""Stand up, walk forward, sideways and in a turn, stop, sit down: a robot in one gait on level ground, by truth."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from sim_agent.study.posture import belly_on_ground, rise, sit
from sim_agent.study.result import Result
from sim_agent.study.rig import DT, STILL, Rig
from sim_agent.study.speeds import DIRECTIONS, Pace, pace_of, parameters_for
from sim_agent.study.watch import Watch
from sim_agent.worlds import make_world
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

WAYS = tuple(DIRECTIONS)
STRIDES = 2
"""Over which the speed is taken, whole ones."""
LONGEST_STOP = 3.0
"""Strides."""


def walk_course(robot: RobotDescription, gait: str, seed: int, ways: tuple[str, ...] = WAYS) -> list[Result]:
    """All manoeuvres one after the other in one run; a robot that fell does not go on."""
    rig = Rig(robot, make_world("flat", seed), seed)
    parameters = rig.parameters = parameters_for(robot, gait)
    try:
        stood = rise(rig, gait)
        results: list[Result] = []
        for way in ways:
            if stood and not (results and results[-1].fell):
                results.append(_walk(rig, gait, way, pace_of(robot, gait, way, parameters)))
            else:
                results.append(_not_walked(robot, gait, way, stood))
        if not results[-1].stood or results[-1].fell:
            return results
        sat = sit(rig, gait)
        on_belly = belly_on_ground(rig)
        return [replace(result, sat=sat, belly_on_ground=on_belly) for result in results]
    finally:
        rig.close()


def _walk(rig: Rig, gait: str, way: str, pace: Pace) -> Result:
    """Get under way for a stride, measure the speed over `STRIDES`, and stop."""
    started, begun = time.thread_time(), rig.seconds
    watch, rig.torque_share = Watch(), 0.0
    rig.parameters = replace(rig.parameters, stride_frequency=pace.frequency)
    under_way = round((rig.robot.locomotion.start_time + 1.0 / pace.frequency) / DT)
    measured = round(STRIDES / pace.frequency / DT)
    before = after = rig.truth()
    for tick in range(under_way + measured):
        rig.step(gait=gait, velocity=pace.velocity)
        if tick < under_way:
            before = rig.truth()
        after = rig.truth()
        if not watch.look(rig):
            break
    for _ in range(0 if watch.fell else round(LONGEST_STOP / pace.frequency / DT)):
        rig.step(gait=gait, velocity=STILL)
        if not watch.look(rig) or rig.out.posture == "standing":
            break
    static = rig.robot.gait(gait).fewest_standing >= 3
    seconds = rig.seconds - begun
    return Result(
        robot=rig.robot.name,
        gait=gait,
        world="flat",
        manoeuvre=way,
        stood=True,
        fell=watch.fell,
        sat=None,
        belly_on_ground=None,
        asked=float(np.linalg.norm(pace.velocity)),
        achieved=_speed(before, after, way, measured * DT),
        static_margin_mm=1e3 * watch.static_margin if static else None,
        energy_margin_mm=1e3 * watch.energy_margin if static else None,
        largest_tilt_deg=float(np.rad2deg(watch.tilt)),
        torque_share=rig.torque_share,
        touches=watch.touches,
        seconds=seconds,
        real_time_factor=seconds / (time.thread_time() - started),
    )


def _speed(before: Pose, after: Pose, way: str, seconds: float) -> float:
    """Mean true speed along what was asked, as the body saw it at the beginning."""
    turned = before.rotation.T @ after.rotation
    yaw = float(np.arctan2(turned[1, 0], turned[0, 0]))
    moved = before.rotation.T @ (after.position - before.position)
    along = {"forward": float(moved[0]), "sideways": float(moved[1]), "turn": yaw}[way]
    return along / seconds


def _not_walked(robot: RobotDescription, gait: str, way: str, stood: bool) -> Result:
    return Result(
        robot=robot.name,
        gait=gait,
        world="flat",
        manoeuvre=way,
        stood=stood,
        fell=stood,
        sat=None,
        belly_on_ground=None,
        asked=0.0,
        achieved=0.0,
        static_margin_mm=None,
        energy_margin_mm=None,
        largest_tilt_deg=0.0,
        torque_share=0.0,
        touches=0,
        seconds=0.0,
        real_time_factor=0.0,
    )
