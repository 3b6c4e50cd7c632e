"""A gait without physics: where feet and joints go when every foot finds flat ground where it is expected."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from robot_agent.locomotion.walker import Walker
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

IDLE_TICKS = 5
"""Ticks before the velocity is given, as in the recordings the columns come from."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrajectoryTick:
    tick: int
    joint_position: Array  # (joints,) rad
    joint_rate: Array  # (joints,) rad/s
    walk: WalkOutput | None  # None in tick 0, the state before the first


def kinematic_gait(
    robot: RobotDescription,
    *,
    gait: str,
    velocity: Array,
    ticks: int,
    parameters: GaitParameters,
    dt: float,
) -> Iterator[TrajectoryTick]:
    """Ticks 0..ticks of a robot that stands, is given `velocity` (vx, vy, turn) once before tick 6, and walks."""
    config = robot.locomotion.model_copy(update={"feel_ground": False, "compensate_servos": False})
    walker = Walker(robot, config, dt)
    joints = walker.begin_standing()
    yield TrajectoryTick(tick=0, joint_position=joints, joint_rate=np.zeros_like(joints), walk=None)
    for tick in range(1, ticks + 1):
        walk = walker.step(
            WalkInput(
                stamp_ns=round(tick * dt * 1e9),
                velocity=velocity if tick > IDLE_TICKS else np.zeros(3),
                parameters=parameters,
                gait=gait,
                stand=True,
                joint_position=joints,
                joint_torque=np.zeros_like(joints),
                foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
        rate = (walk.joint_position - joints) / dt
        joints = walk.joint_position
        yield TrajectoryTick(tick=tick, joint_position=joints, joint_rate=rate, walk=walk)
