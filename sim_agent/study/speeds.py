"""At which frequency and speeds a gait is walked on level ground: what the robot allows itself, a little less."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion import Walker, WalkInput
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

SHARE = 0.6
"""Of the largest speed that stride and frequency allow."""
RESERVE = 0.95
"""Of what the walker grants."""
SLACK = 0.8
"""Of the frequency that unloaded servos can follow: feet that seek the ground need some of their speed as well."""
QUICK = 1.5
"""Swing time over the shortest, of gaits that are not statically stable."""
SETTLING = 300  # ticks
STRIDES = 2
"""Walked in the rehearsal once it has settled."""
LONGEST_REHEARSAL = 3000  # ticks
DT = 0.01  # s

DIRECTIONS = {"forward": (1.0, 0.0, 0.0), "sideways": (0.0, 1.0, 0.0), "turn": (0.0, 0.0, 1.0)}


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """How to walk: `velocity` (3,) in m/s and rad/s, and the stride's frequency in Hz that goes with it."""

    velocity: Array
    frequency: float


def flat_ground(robot: RobotDescription) -> GaitParameters:
    """What the adaptation chooses on smooth level ground."""
    adaptation = robot.adaptation
    return GaitParameters(
        stamp_ns=0,
        virtual_stiffness=adaptation.stiffness_polynomial[0],
        stride_frequency=adaptation.frequency_polynomial[0],
        stride_height=adaptation.height_polynomial[0],
        confidence=1.0,
    )


def parameters_for(robot: RobotDescription, gait: str) -> GaitParameters:
    """Those for level ground; gaits on fewer than three feet have to be quick."""
    parameters, timing = flat_ground(robot), robot.gait(gait)
    if timing.fewest_standing >= 3:
        return parameters
    quick = timing.swing / (QUICK * robot.locomotion.shortest_swing)
    return replace(parameters, stride_frequency=min(quick, robot.adaptation.stride_frequency.upper))


def pace_of(robot: RobotDescription, gait: str, way: str, parameters: GaitParameters) -> Pace:
    """The pace in one of `DIRECTIONS`, found by rehearsing the gait without physics."""
    timing, locomotion = robot.gait(gait), robot.locomotion
    frequency = min(parameters.stride_frequency, timing.swing / locomotion.shortest_swing)
    speed = SHARE * min(locomotion.largest_stride * frequency / timing.duty, locomotion.largest_speed)
    order = speed * np.array(DIRECTIONS[way])
    order[2] /= float(np.linalg.norm(robot.stance_in_body[:, :2], axis=1).mean())
    granted, frequency = _rehearse(robot, gait, order, parameters)
    slack = SLACK if timing.fewest_standing >= 3 else 1.0
    share = min(1.0, slack * RESERVE * granted / float(np.linalg.norm(order)))
    return Pace(velocity=order * share, frequency=slack * frequency)


def _rehearse(robot: RobotDescription, gait: str, order: Array, parameters: GaitParameters) -> tuple[float, float]:
    """The mean size of the velocity that comes of an order, and the stride's frequency in Hz, over whole strides."""
    config = robot.locomotion.model_copy(update={"feel_ground": False})
    walker = Walker(robot, config, DT)
    joints = walker.begin_standing()
    phase, turned = np.zeros(robot.leg_count), 0.0
    granted: list[float] = []
    tick = 0
    while turned < STRIDES and tick < LONGEST_REHEARSAL:
        out = walker.step(
            WalkInput(
                stamp_ns=round(tick * DT * 1e9),
                velocity=order,
                parameters=parameters,
                gait=gait,
                stand=True,
                joint_position=joints,
                joint_torque=np.zeros_like(joints),
                foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
        if tick >= SETTLING:
            turned += float(np.median((out.phase - phase) % 1.0))
            granted.append(float(np.linalg.norm(out.velocity)))
        joints, phase = out.joint_position, out.phase
        tick += 1
    return float(np.mean(granted)), turned / (len(granted) * DT)
