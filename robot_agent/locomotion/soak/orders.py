"""Random readings and orders of one robot: mostly sensible, sometimes wild, sometimes not numbers at all."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

BAD = np.array([np.nan, np.inf, -np.inf, 1e300, -1e12, 0.0])
CHANGES = 0.01
"""Chance, a tick, that any one order changes."""
FAULTS = 0.02
"""Chance, a tick, that a reading is at fault."""


class RandomOrders:
    """Makes the next tick's input from the last tick's output."""

    def __init__(self, robot: RobotDescription, rng: np.random.Generator) -> None:
        self._robot, self._rng = robot, rng
        self._velocity = np.zeros(3)
        self._parameters = _parameters(1.0, 0.05, 1500.0)
        self._gait = robot.gaits[0]
        self._stand = True
        self._in_sequence = self._pack = False
        self._posing = NO_POSING
        self._legs: tuple[LegOrder, ...] = ()
        self._down = np.array([0.0, 0.0, -1.0])

    def next(self, joints: Array, last: WalkOutput | None) -> WalkInput:
        self._change()
        rng, robot = self._rng, self._robot
        contact = np.ones(robot.leg_count, dtype=np.bool_) if last is None else ~last.swing | (last.phase > 0.3)
        if rng.random() < FAULTS:
            contact = rng.random(robot.leg_count) < rng.random()
        return WalkInput(
            stamp_ns=0,
            velocity=self._spoilt(self._velocity),
            parameters=self._parameters,
            gait=self._gait,
            stand=self._stand,
            joint_position=self._spoilt(joints + rng.normal(0.0, 2e-3, joints.size)),
            joint_torque=self._spoilt(rng.normal(0.0, 1.0, joints.size)),
            foot_contact=contact,
            gravity_in_body=self._spoilt(self._down),
            posing=self._posing,
            legs=self._legs,
            in_sequence=self._in_sequence,
            pack=self._pack,
        )

    def _change(self) -> None:
        rng = self._rng
        changes = rng.random(7) < CHANGES
        if changes[0]:
            self._velocity = rng.normal(0.0, 0.2, 3) * rng.choice([0.0, 1.0, 1.0, 30.0])
        if changes[1]:
            values = rng.uniform([0.05, 0.0, 100.0], [2.0, 0.2, 6000.0])
            self._parameters = _parameters(*self._spoilt(values, chance=0.2))
        if changes[2]:
            self._gait = str(rng.choice([*self._robot.gaits, "gallop"]))
        if changes[3]:
            self._stand = bool(rng.random() < 0.8)
            self._in_sequence, self._pack = bool(rng.random() < 0.3), bool(rng.random() < 0.3)
        if changes[4]:
            manual = self._spoilt(rng.normal(0.0, 0.05, 6), chance=0.2)
            self._posing = PosingOrder(
                manual=tuple(manual), automatic=bool(rng.random() < 0.5), levelling=bool(rng.random() < 0.5)
            )
        if changes[5]:
            tilted = rng.normal(0.0, 0.2, 3) * rng.choice([0.0, 1.0, 5.0]) - np.array([0.0, 0.0, 1.0])
            self._down = tilted / np.linalg.norm(tilted)
        if changes[6]:
            self._legs = tuple(self._leg() for _ in range(rng.choice([0, 0, 1, 2, 3])))
            if self._legs and rng.random() < 0.7:
                self._velocity = np.zeros(3)  # a walking robot lifts none

    def _leg(self) -> LegOrder:
        """A leg, not always one that the robot has, to be held by its tip or by its joints."""
        rng, joints = self._rng, self._robot.joints_per_leg
        tip = self._spoilt(rng.normal(0.0, 0.06, 3), chance=0.2)
        angles = self._spoilt(rng.uniform(-2.0, 2.0, joints + int(rng.random() < 0.1)), chance=0.2)
        return LegOrder(
            leg=int(rng.integers(-1, self._robot.leg_count + 1)),
            tip=(float(tip[0]), float(tip[1]), float(tip[2])),
            joints=tuple(angles.tolist()) if rng.random() < 0.4 else None,
        )

    def _spoilt(self, values: Array, *, chance: float = FAULTS) -> Array:
        """The values, or now and then a copy with one or all of them replaced, or of the wrong size."""
        rng = self._rng
        if rng.random() >= chance:
            return values
        kind, spoilt = rng.integers(8), values.copy()
        if kind == 0:
            spoilt[:] = rng.choice(BAD)
        elif kind == 1 and chance == FAULTS:
            return spoilt[:-1]
        else:
            spoilt[rng.integers(values.size)] = rng.choice(BAD)
        return spoilt


def _parameters(frequency: Any, height: Any, stiffness: Any) -> GaitParameters:
    return GaitParameters(
        stamp_ns=0,
        virtual_stiffness=float(stiffness),
        stride_frequency=float(frequency),
        stride_height=float(height),
        confidence=1.0,
    )
