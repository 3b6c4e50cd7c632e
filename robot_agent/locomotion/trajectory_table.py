"""A kinematic gait as rows of text: one a tick and leg, with the columns of the OpenSHC recordings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.stride import stride_of
from robot_agent.locomotion.trajectory import TrajectoryTick
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.robots.gaits import Gait
from weaver_shared.transforms import wxyz_from_rotation

Array = NDArray[np.float64]

SWING, STANCE, STOPPED = 0, 1, 3


def columns(joints_per_leg: int) -> list[str]:
    """Names in order; m, rad, s, N; phase in ticks since the middle of the stance."""
    names = ["tick", "leg", "step_state", "phase", "swing_progress", "stance_progress"]
    for vector in ("walker_", "walker_v", "target_", "default_", "stride_", "poser_", "model_"):
        names += [vector + axis for axis in "xyz"]
    names += ["model_q" + part for part in "wxyz"]
    names += ["adm_" + axis for axis in "xyz"] + ["virtual_stiffness"]
    names += ["force_calc_" + axis for axis in "xyz"]
    for joint in range(joints_per_leg):
        names += [f"q{joint}", f"dq{joint}"]
    return names


def rows(
    robot: RobotDescription,
    gait: Gait,
    ticks: Iterator[TrajectoryTick],
    parameters: GaitParameters,
    dt: float,
) -> Iterator[list[str]]:
    """One list of fields a leg and tick. `walker` is over the ground, `poser` and `model` in body."""
    stance = robot.stance_in_body
    ground = np.array([0.0, 0.0, stance[:, 2].mean()])
    before = stance
    for tick in ticks:
        frames = joint_frames_in_body(robot, tick.joint_position)[:, -1]
        feet = stance if tick.walk is None else tick.walk.foot_in_body
        for leg, name in enumerate(robot.leg_names):
            timing = _timing(tick, gait, leg, parameters.stride_frequency, dt)
            stride = _stride(tick, gait, stance[leg], parameters.stride_frequency)
            place = feet[leg] - ground
            default = stance[leg] - ground
            vectors = [place, (feet[leg] - before[leg]) / dt, default + 0.5 * stride, default, stride, feet[leg]]
            vectors += [frames[leg, :3, 3], wxyz_from_rotation(frames[leg, :3, :3]), np.zeros(3)]
            values = np.concatenate([*vectors, [parameters.virtual_stiffness], np.zeros(3)])
            joints = slice(leg * robot.joints_per_leg, (leg + 1) * robot.joints_per_leg)
            motion = np.column_stack([tick.joint_position[joints], tick.joint_rate[joints]]).ravel()
            numbers = [f"{value:.10g}" for value in np.concatenate([timing, values, motion]) + 0.0]
            yield [str(tick.tick), name, *numbers]
        before = feet


def _timing(tick: TrajectoryTick, gait: Gait, leg: int, frequency: float, dt: float) -> Array:
    """step_state, phase (ticks), swing and stance progress, -1 outside."""
    if tick.walk is None or tick.walk.posture != "walking":
        return np.array([STOPPED, 0.0, -1.0, 0.0])
    phase = float(tick.walk.phase[leg])
    since_mid_stance = (phase + 0.5 * gait.duty) % 1.0 / (frequency * dt)
    if tick.walk.swing[leg]:
        return np.array([SWING, since_mid_stance, phase / gait.swing, -1.0])
    return np.array([STANCE, since_mid_stance, -1.0, max(phase - gait.swing, 0.0) / gait.duty])


def _stride(tick: TrajectoryTick, gait: Gait, stance: Array, frequency: float) -> Array:
    stride = np.zeros(3)
    if tick.walk is not None:
        stride_of(tick.walk.velocity, stance, gait.duty, frequency, stride)
    return stride
