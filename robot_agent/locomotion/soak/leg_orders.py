"""Random orders that concern legs: held off the ground, put down somewhere, turned into another posture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.footholds import FootholdOrder
from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posture_order import PostureOrder
from robot_agent.locomotion.soak.spoilt import spoilt
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

SERIALS = 40
"""Few enough that now and then an order comes with one that was there before."""
POSTURES = (*2 * ("insectoid", "mammalian"), "upside down", "")


def random_leg_order(robot: RobotDescription, rng: np.random.Generator) -> LegOrder:
    """A leg, not always one that the robot has, to be held by its tip or by its joints."""
    tip = spoilt(rng, rng.normal(0.0, 0.06, 3), chance=0.2)
    angles = spoilt(rng, rng.uniform(-2.0, 2.0, robot.joints_per_leg + int(rng.random() < 0.1)), chance=0.2)
    return LegOrder(
        leg=_leg(robot, rng), tip=_triple(tip), joints=tuple(angles.tolist()) if rng.random() < 0.4 else None
    )  # fmt: skip


def random_foothold(robot: RobotDescription, rng: np.random.Generator) -> FootholdOrder:
    """A place about the stance of a leg, within its reach or far beyond, or none at all."""
    leg = _leg(robot, rng)
    stance = robot.stance_in_body[leg % robot.leg_count]
    away = rng.normal(0.0, 0.05, 3) * rng.choice([1.0, 1.0, 20.0])
    return FootholdOrder(
        leg=leg, serial=int(rng.integers(-1, SERIALS)), place=_triple(spoilt(rng, stance + away, chance=0.3))
    )


def random_posture(rng: np.random.Generator) -> PostureOrder:
    """A posture that the robot may have, or be in already, or that nobody knows."""
    return PostureOrder(name=str(rng.choice(POSTURES)), serial=int(rng.integers(SERIALS)))


def _leg(robot: RobotDescription, rng: np.random.Generator) -> int:
    return int(rng.integers(-1, robot.leg_count + 1))


def _triple(values: Array) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z
