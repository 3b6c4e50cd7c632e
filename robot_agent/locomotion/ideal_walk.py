"""A robot walking on nothing but its own commands, for timing and warming up: all readings are as they should be.

Joints do as they are told, feet touch the ground when their swing ends, torques carry the load that every foot is
expected to, and gravity is seen from the posed body.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from robot_agent.locomotion.walker import Walker
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]


class IdealWalk:
    """A walk with the same orders all along: velocity (3,) m/s and rad/s, frequency Hz, tick `dt` s."""

    def __init__(
        self,
        robot: RobotDescription,
        config: LocomotionConfig,
        *,
        velocity: Array,
        frequency: float = 1.0,
        posing: PosingOrder = NO_POSING,
        dt: float = 0.01,
    ) -> None:
        self._robot, self._config, self._dt = robot, config, dt
        self._velocity, self._posing, self._gait = velocity, posing, robot.gait(robot.gaits[0])
        self._parameters = GaitParameters(
            stamp_ns=0,
            virtual_stiffness=1000.0,
            stride_frequency=frequency,
            stride_height=robot.locomotion.height_bounds[0],
            confidence=1.0,
        )

    def inputs(self, ticks: int) -> Iterator[WalkInput]:
        """The readings of `ticks` ticks, each from the answer to the one before."""
        walker = Walker(self._robot, self._config, self._dt)
        joints = walker.begin_standing()
        contact, down = np.ones(self._robot.leg_count, dtype=np.bool_), np.array([0.0, 0.0, -1.0])
        for _ in range(ticks):
            sensed = self._sensed(joints, walker.carrying_torque(), contact, down)
            yield sensed
            out = walker.step(sensed)
            joints, contact, down = out.joint_position, self._touching(out), -out.unposed_from_body.rotation[2]

    def replay(self, ticks: int) -> Callable[[], WalkOutput]:
        """A function that takes one of `ticks` ticks, for which readings are made beforehand: input, step, targets."""
        readings = iter(list(self.inputs(ticks)))
        walker = Walker(self._robot, self._config, self._dt)
        walker.begin_standing()

        def tick() -> WalkOutput:
            given = next(readings)
            out = walker.step(
                self._sensed(given.joint_position, given.joint_torque, given.foot_contact, given.gravity_in_body)
            )
            _ = out.joint_position
            return out

        return tick

    def _sensed(self, joints: Array, torque: Array, contact: NDArray[np.bool_], down: Array) -> WalkInput:
        return WalkInput(
            stamp_ns=0,
            velocity=self._velocity,
            parameters=self._parameters,
            gait=self._gait.name,
            stand=True,
            joint_position=joints,
            joint_torque=torque,
            foot_contact=contact,
            gravity_in_body=down,
            posing=self._posing,
        )

    def _touching(self, out: WalkOutput) -> NDArray[np.bool_]:
        return ~out.swing | (out.phase >= self._gait.swing)
