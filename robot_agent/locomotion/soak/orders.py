"""Random readings and orders of one robot: mostly sensible, sometimes wild, sometimes not numbers at all."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.footholds import FootholdOrder
from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.posture_order import NO_POSTURE_ORDER
from robot_agent.locomotion.soak.leg_orders import random_foothold, random_leg_order, random_posture
from robot_agent.locomotion.soak.spoilt import FAULTS, spoilt
from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

CHANGES = 0.01
"""Chance, a tick, that any one order changes."""
CALM = 0.1
"""Of these changes, in a calm life: one in which the robot mostly stands, so that there is time to change posture."""


class RandomOrders:
    """Makes the next tick's input from the last tick's output."""

    def __init__(self, robot: RobotDescription, rng: np.random.Generator, *, calm: bool = False) -> None:
        self._robot, self._rng, self._calm = robot, rng, calm
        self._velocity = np.zeros(3)
        self._parameters = _parameters(1.0, 0.05, 1500.0)
        self._gait = robot.gaits[0]
        self._stand = True
        self._in_sequence = self._pack = False
        self._posing = NO_POSING
        self._legs: tuple[LegOrder, ...] = ()
        self._footholds: tuple[FootholdOrder, ...] = ()
        self._posture = NO_POSTURE_ORDER
        self._down = np.array([0.0, 0.0, -1.0])

    def next(self, joints: Array, last: WalkOutput | None) -> WalkInput:
        self._change()
        rng, robot = self._rng, self._robot
        contact = np.ones(robot.leg_count, dtype=np.bool_) if last is None else ~last.swing | (last.phase > 0.3)
        if rng.random() < FAULTS:
            contact = rng.random(robot.leg_count) < rng.random()
        return WalkInput(
            stamp_ns=0,
            velocity=spoilt(rng, self._velocity),
            parameters=self._parameters,
            gait=self._gait,
            stand=self._stand,
            joint_position=spoilt(rng, joints + rng.normal(0.0, 2e-3, joints.size)),
            joint_torque=spoilt(rng, rng.normal(0.0, 1.0, joints.size)),
            foot_contact=contact,
            gravity_in_body=spoilt(rng, self._down),
            posing=self._posing,
            legs=self._legs,
            footholds=self._footholds,
            posture_order=self._posture,
            in_sequence=self._in_sequence,
            pack=self._pack,
        )

    def _change(self) -> None:
        rng, calm = self._rng, self._calm
        changes = rng.random(9) < CHANGES * (CALM if calm else 1.0)
        if changes[0]:
            self._velocity = rng.normal(0.0, 0.2, 3) * rng.choice([0.0, 1.0, 1.0, 30.0])
        if changes[1]:
            values = rng.uniform([0.05, 0.0, 100.0], [2.0, 0.2, 6000.0])
            self._parameters = _parameters(*spoilt(rng, values, chance=0.2))
        if changes[2]:
            self._gait = str(rng.choice([*self._robot.gaits, "gallop"]))
        if changes[3]:
            self._stand = bool(rng.random() < 0.8)
            self._in_sequence, self._pack = bool(rng.random() < 0.3), bool(rng.random() < 0.3)
        if changes[4]:
            manual = spoilt(rng, rng.normal(0.0, 0.05, 6), chance=0.2)
            self._posing = PosingOrder(
                manual=tuple(manual), automatic=bool(rng.random() < 0.5), levelling=bool(rng.random() < 0.5)
            )
        if changes[5]:
            tilted = rng.normal(0.0, 0.2, 3) * rng.choice([0.0, 1.0, 5.0]) - np.array([0.0, 0.0, 1.0])
            self._down = tilted / np.linalg.norm(tilted)
        if changes[6]:
            self._legs = tuple(random_leg_order(self._robot, rng) for _ in range(rng.choice([0, 0, 1, 2, 3])))
            if self._legs and rng.random() < 0.7:
                self._velocity = np.zeros(3)  # a walking robot lifts none
        if changes[7] or changes[8]:
            self._footholds = tuple(random_foothold(self._robot, rng) for _ in range(rng.choice([0, 1, 2, 4])))
        if rng.random() < (3.0 if calm else 1.0) * CHANGES:
            self._posture = random_posture(rng)
        if calm and rng.random() < 0.2 * CHANGES:  # a robot that walks, poses or holds a leg does not change
            self._velocity, self._posing, self._legs, self._stand = np.zeros(3), NO_POSING, (), True


def _parameters(frequency: Any, height: Any, stiffness: Any) -> GaitParameters:
    return GaitParameters(
        stamp_ns=0,
        virtual_stiffness=float(stiffness),
        stride_frequency=float(frequency),
        stride_height=float(height),
        confidence=1.0,
    )
