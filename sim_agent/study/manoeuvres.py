"""Stand up, walk forward, sideways and in a turn, stop, sit down: a robot in one gait on level ground, by truth."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim_agent.study.rig import DT, Rig
from sim_agent.worlds import make_world
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import rpy_from_rotation

Array = NDArray[np.float64]

LONGEST_RISE = 30.0  # s
SPEED_SHARE = 0.6
"""Of the largest speed that stride and frequency allow."""
QUICK = 1.5
"""Swing time over the shortest, of gaits that are not statically stable."""
STRIDES = 6.0
"""Walked in each direction."""
FALLEN_TILT = 0.45  # rad
FALLEN_HEIGHT = 0.5
"""Of the clearance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """One part of the course: what was asked and what came of it. Speeds in m/s (turn: rad/s), lengths in m."""

    name: str
    asked: float
    walked: float  # mean true speed along what was asked, of the second half
    seconds: float
    smallest_margin: float  # static, while every second reading is good; NaN for gaits without static support
    smallest_energy_margin: float
    largest_tilt: float  # rad
    lowest: float  # of the body, over the clearance


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """`fell` says where, empty if nowhere."""

    robot: str
    gait: str
    stood: bool
    sat: bool
    fell: str
    belly_touches: int  # ticks in which anything but a foot touched the ground while upright
    parts: tuple[Leg, ...]

    @property
    def passed(self) -> bool:
        return self.stood and self.sat and not self.fell and all(part.walked > 0.4 * part.asked for part in self.parts)

    def figures(self) -> dict[str, Any]:
        return {**asdict(self), "passed": self.passed}


def walk_course(robot: RobotDescription, gait: str, seed: int = 1) -> Course:
    """All manoeuvres one after the other in one run; a robot that fell does not go on."""
    rig = Rig(robot, make_world("flat", seed), seed)
    try:
        return _course(rig, gait)
    finally:
        rig.close()


def _course(rig: Rig, gait: str) -> Course:
    speed = usual_speed(rig.robot, gait)
    rig.parameters = replace(rig.parameters, stride_frequency=stride_frequency(rig.robot, gait))
    radius = float(np.linalg.norm(rig.robot.stance_in_body[:, :2], axis=1).mean())
    orders = {
        "forward": np.array([speed, 0.0, 0.0]),
        "sideways": np.array([0.0, speed, 0.0]),
        "turn": np.array([0.0, 0.0, speed / radius]),
    }
    stood = rise(rig, gait)
    parts: list[Leg] = []
    touches, fell = 0, "" if stood else "standing up"
    for name, velocity in orders.items():
        if fell:
            break
        part, touched, down = _walk(rig, gait, name, velocity)
        parts.append(part)
        touches += touched
        fell = name if down else ""
    sat = not fell and sit(rig, gait)
    return Course(
        robot=rig.robot.name, gait=gait, stood=stood, sat=sat, fell=fell, belly_touches=touches, parts=tuple(parts)
    )


def usual_speed(robot: RobotDescription, gait: str) -> float:
    """A good part of what the gait allows at the frequency for level ground, m/s."""
    locomotion, timing = robot.locomotion, robot.gait(gait)
    frequency = stride_frequency(robot, gait)
    possible = locomotion.largest_stride * frequency / timing.duty
    return SPEED_SHARE * min(possible, locomotion.largest_speed)


def stride_frequency(robot: RobotDescription, gait: str) -> float:
    """Hz walked in that gait on level ground; gaits on fewer than three feet have to be quick."""
    timing, locomotion = robot.gait(gait), robot.locomotion
    usual = robot.adaptation.frequency_polynomial[0]
    if timing.fewest_standing < 3:
        usual = min(timing.swing / (QUICK * locomotion.shortest_swing), robot.adaptation.stride_frequency.upper)
    return min(usual, timing.swing / locomotion.shortest_swing)


def rise(rig: Rig, gait: str) -> bool:
    """Whether it stands, as high as described, within the longest time."""
    for _ in range(round(LONGEST_RISE / DT)):
        rig.step(gait=gait)
        assert rig.out is not None
        if rig.out.posture == "standing":
            break
    for _ in range(round(1.0 / DT)):
        rig.step(gait=gait)
    truth = rig.truth()
    return rig.out is not None and rig.out.posture == "standing" and truth.position[2] > 0.9 * rig.robot.clearance


def sit(rig: Rig, gait: str) -> bool:
    """Whether it ends on its belly, level, with its joints still."""
    for _ in range(round(LONGEST_RISE / DT)):
        sensed = rig.step(gait=gait, stand=False)
        assert rig.out is not None
        if rig.out.posture == "sitting":
            break
    for _ in range(round(0.5 / DT)):
        sensed = rig.step(gait=gait, stand=False)
    roll, pitch, _ = rpy_from_rotation(rig.truth().rotation)
    still = float(np.abs(sensed.joint_velocity).max()) < 0.3
    sits = rig.out is not None and rig.out.posture == "sitting"
    return sits and still and float(np.hypot(roll, pitch)) < FALLEN_TILT


def _walk(rig: Rig, gait: str, name: str, velocity: Array) -> tuple[Leg, int, bool]:
    """Walk for some strides, then stop; returns the figures, ticks with another part on the ground, whether it fell."""
    robot = rig.robot
    seconds = STRIDES / stride_frequency(robot, gait) + 2.0
    ticks = round(seconds / DT)
    margins, energies, tilts, heights = [], [], [], []
    touched, begin = 0, rig.truth()
    for tick in range(ticks + round(4.0 / stride_frequency(robot, gait) / DT)):
        order = velocity if tick < ticks else np.zeros(3)
        rig.step(gait=gait, velocity=order)
        assert rig.out is not None
        if tick >= ticks and rig.out.posture == "standing":
            break
        pose = rig.truth()
        if tick == ticks // 2:
            begin = pose
        if tick == ticks - 1:
            end = pose
        _, rest = rig.body.contact_forces()
        touched += bool(np.abs(rest).max() > 0.0)
        roll, pitch, _ = rpy_from_rotation(pose.rotation)
        tilts.append(float(np.hypot(roll, pitch)))
        heights.append(float(pose.position[2]) / robot.clearance)
        margins.append(rig.out.stability_margin)
        energies.append(rig.out.energy_margin)
        if tilts[-1] > FALLEN_TILT or heights[-1] < FALLEN_HEIGHT:
            end = pose
            break
    moved = begin.rotation.T @ (end.position - begin.position)
    half = (ticks - ticks // 2) * DT
    turned = begin.rotation.T @ end.rotation
    yaw = float(np.arctan2(turned[1, 0], turned[0, 0]))
    walked = {"forward": float(moved[0]), "sideways": float(moved[1]), "turn": yaw}[name] / half
    fell = tilts[-1] > FALLEN_TILT or heights[-1] < FALLEN_HEIGHT
    static = robot.gait(gait).fewest_standing >= 3
    part = Leg(
        name=name,
        asked=float(np.abs(velocity).max()),
        walked=walked,
        seconds=len(tilts) * DT,
        smallest_margin=float(np.min(margins)) if static else float("nan"),
        smallest_energy_margin=float(np.min(energies)) if static else float("nan"),
        largest_tilt=float(np.max(tilts)),
        lowest=float(np.min(heights)),
    )
    return part, touched, fell
