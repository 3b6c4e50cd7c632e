"""Straight ahead over a world that rises and falls, by the robot's own senses, judged by truth."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from sim_agent.study.manoeuvres import FALLEN_TILT, rise, stride_frequency, usual_speed
from sim_agent.study.rig import DT, Rig
from sim_agent.worlds import make_world
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import yaw_of

CAUTION = 0.6
"""Of the speed for level ground."""
LONGEST = 180.0  # s
HEADING_GAIN = 0.8  # 1/s, keeps the course by truth: the study is about legs, not about odometry
PATH_GAIN = 0.6  # 1/m


@dataclass(frozen=True, slots=True, kw_only=True)
class Climb:
    """`reached` m of `course` m along x; margins are the static one, m."""

    robot: str
    world: str
    gait: str
    reached: float
    course: float
    seconds: float
    fell: bool
    highest: float  # m, of the ground that the body passed over
    smallest_margin: float
    fifth_percentile_margin: float
    largest_tilt: float  # rad

    @property
    def passed(self) -> bool:
        return not self.fell and self.reached >= self.course

    def figures(self) -> dict[str, Any]:
        return {**asdict(self), "passed": self.passed}


def climb(robot: RobotDescription, world_name: str, gait: str, *, swing_height: float, seed: int = 1) -> Climb:
    """Stand up, walk along x to behind the last rise, with feet swinging `swing_height` m high."""
    world = make_world(world_name, seed)
    course = max(float(box.centre[0] + box.half[0]) for box in world.boxes) + 0.4
    rig = Rig(robot, world, seed)
    try:
        return _climb(rig, world_name, gait, swing_height, course)
    finally:
        rig.close()


def _climb(rig: Rig, world_name: str, gait: str, swing_height: float, course: float) -> Climb:
    robot, world = rig.robot, rig.body.world
    frequency = CAUTION * stride_frequency(robot, gait)
    rig.parameters = replace(rig.parameters, stride_frequency=frequency, stride_height=swing_height)
    speed = CAUTION * usual_speed(robot, gait)
    fell = not rise(rig, gait)
    margins, tilts, highest, x, ticks = [], [], 0.0, 0.0, 0
    steepest = 0.0
    while not fell and x < course and ticks < round(LONGEST / DT):
        pose = rig.truth()
        x, y, _ = (float(value) for value in pose.position)
        turn = HEADING_GAIN * (float(np.arctan(-PATH_GAIN * y)) - yaw_of(pose.rotation))
        rig.step(gait=gait, velocity=np.array([speed, 0.0, np.clip(turn, -0.3, 0.3)]))
        assert rig.out is not None
        here = float(world.elevation(x, y))
        highest = max(highest, here)
        ahead, behind = (float(world.elevation(x + way, y)) for way in (0.3, -0.3))
        steepest = max(steepest, abs(ahead - behind) / 0.6)
        margins.append(rig.out.stability_margin)
        tilts.append(float(np.arccos(np.clip(pose.rotation[2, 2], -1.0, 1.0))))
        fell = tilts[-1] > FALLEN_TILT + float(np.arctan(steepest)) or pose.position[2] - here < 0.3 * robot.clearance
        ticks += 1
    return Climb(
        robot=robot.name,
        world=world_name,
        gait=gait,
        reached=x,
        course=course,
        seconds=ticks * DT,
        fell=bool(fell),
        highest=highest,
        smallest_margin=float(np.min(margins)) if margins else float("nan"),
        fifth_percentile_margin=float(np.percentile(margins, 5)) if margins else float("nan"),
        largest_tilt=float(np.max(tilts)) if tilts else float("nan"),
    )
