"""A soak: many robots in turn, each living some ticks of random readings and orders, every answer checked."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.postures import Postures
from robot_agent.locomotion.soak.orders import RandomOrders
from robot_agent.locomotion.soak.robots import random_robot
from robot_agent.locomotion.walk_tick import WalkOutput
from weaver_shared.robots import RobotDescription, load_robot, robot_names

Array = NDArray[np.float64]

TICKS_OF_A_LIFE = 1500
CALM_LIFE = 4
"""Times as long: so long a change of posture takes."""
RATES = (50.0, 100.0, 200.0)  # Hz
RESETS = 0.001
"""Chance, a tick, that the torque is taken off the joints and given back."""
ROUNDING = 1e-9
Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Violation:
    """The first thing that went wrong in a life, and how to see it again: `soak(..., seed=seed, first=life)`."""

    life: int
    robot: str
    tick: int
    what: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SoakResult:
    ticks: int
    lives: int
    violations: tuple[Violation, ...]
    ticks_by_posture: dict[str, int]
    ticks_by_robot: dict[str, int]


def soak(
    ticks: int, *, seed: int = 1, first: int = 0, life: int = TICKS_OF_A_LIFE, progress: Progress | None = None
) -> SoakResult:
    """Live at least `ticks` ticks: shipped robots and random ones by turns, from life number `first` on."""
    postures: Counter[str] = Counter()
    robots: Counter[str] = Counter()
    violations, done, number = [], 0, first
    while done < ticks:
        rng = np.random.default_rng((seed, number))
        robot = _robot(rng, number)
        lived, what = _live(robot, rng, life, postures)
        if what:
            violations.append(Violation(life=number, robot=robot.name, tick=lived, what=what))
        done, number = done + lived, number + 1
        robots["random" if robot.name.startswith("random-") else robot.name] += lived
        if progress:
            progress(done, len(violations))
    return SoakResult(
        ticks=done,
        lives=number - first,
        violations=tuple(violations),
        ticks_by_posture=dict(postures),
        ticks_by_robot=dict(robots),
    )


def _robot(rng: np.random.Generator, number: int) -> RobotDescription:
    names = robot_names()
    return random_robot(rng, number) if number % 2 else load_robot(names[number // 2 % len(names)])


def _live(robot: RobotDescription, rng: np.random.Generator, ticks: int, postures: Counter[str]) -> tuple[int, str]:
    """Ticks lived and what was wrong with the last of them, if anything."""
    dt = 1.0 / float(rng.choice(RATES))
    config = robot.locomotion.model_copy(
        update={"feel_ground": bool(rng.random() < 0.8), "compensate_servos": bool(rng.random() < 0.8)}
    )
    calm = robot.posture is not None and rng.random() < 0.5
    walker = Postures(robot.model_copy(update={"locomotion": config}), dt)
    orders = RandomOrders(robot, rng, calm=calm)
    limits = np.tile(robot.joint_limits, (robot.leg_count, 1))
    speed = np.tile([robot.servos[joint.servo].no_load_speed for joint in robot.joints], robot.leg_count)
    joints = rng.uniform(limits[:, 0], limits[:, 1])
    walker.reset(joints)
    if calm or rng.random() < 0.5:
        joints = walker.begin_standing()
    out: WalkOutput | None = None
    for tick in range(CALM_LIFE * ticks if calm else ticks):
        sensed = orders.next(joints, out)
        let_go = bool(rng.random() < RESETS)
        try:
            if let_go:
                walker.reset(sensed.joint_position)
            out = walker.step(sensed)
        except Exception as error:  # whatever it is, it is what is looked for
            return tick + 1, f"raised {type(error).__name__}: {error}"
        what = _wrong(out, joints, limits, np.inf if let_go else speed * dt)
        if what:
            return tick + 1, what
        postures[out.posture] += 1
        joints = out.joint_position
    return tick + 1, ""


def _wrong(out: WalkOutput, before: Array, limits: Array, largest_step: Array | float) -> str:
    joints = out.joint_position
    numbers = (
        joints, out.foot_in_body, out.foot_force, out.phase, out.velocity, out.ground_plane,
        out.unposed_from_body.rotation, out.unposed_from_body.position,
        np.array([out.stability_margin, out.energy_margin, out.ground_residual]),
    )  # fmt: skip
    if not all(np.isfinite(array).all() for array in numbers):
        return "an answer is not finite"
    beyond = np.maximum(limits[:, 0] - joints, joints - limits[:, 1]).max()
    if beyond > ROUNDING:
        return f"a joint is {beyond:.2g} rad beyond its limit"
    over = (np.abs(joints - before) - largest_step).max()
    if over > ROUNDING:
        return f"a joint moves {over:.2g} rad in a tick more than its servo can"
    return ""
