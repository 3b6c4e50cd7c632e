"""A robot's recording as if somebody had picked it up and waved it before a target: to try a calibration with."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from robot_agent.calibration.lens import intrinsics_of
from robot_agent.calibration.rig import Rig, moved
from robot_agent.calibration.target import AprilGrid
from robot_agent.recording import RecordingWriter
from robot_agent.vision.camera import StereoCalibration
from sim_agent.targets.motion import HandHeldMotion, gravity_before
from sim_agent.targets.recording import LENSES, RigTruth, TargetRecording
from weaver_shared import topics
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import ImuBatch, Proprioception, StereoFrame
from weaver_shared.robots import RobotDescription

GRID = AprilGrid(columns=6, rows=6, tag_size=0.088, spacing=0.3)
"""What the console's page looks for unless it is told otherwise; it fills an A1 sheet."""

DISTANCE = 0.8  # m
TICK_NS = 10_000_000
"""A robot tells what its IMU felt a hundred times a second."""


def built_askew(robot: RobotDescription, generator: np.random.Generator) -> RigTruth:
    """The described rig as a workshop leaves it: some mm and a degree or two off, with real lenses and clocks."""
    pair = StereoCalibration.of_robot(robot)
    rig = Rig.of((pair.left, pair.right))
    lenses = np.array([intrinsics_of(eye) for eye in (pair.left, pair.right)])
    lenses[:, :4] *= generator.uniform(0.99, 1.01, (2, 4))
    lenses[:, 4:] = 0.3 * LENSES["radtan"] * generator.uniform(0.8, 1.2, (2, 4))
    described = pair.left.body_from_camera.inverse() @ robot.imu.body_from_imu
    return RigTruth(
        rig=replace(
            rig,
            models=("radtan", "radtan"),
            intrinsics=lenses,
            eye_from_first=(rig.eye_from_first[0], moved(rig.eye_from_first[1], _off(generator, 0.01, 0.001))),
        ),
        camera_from_imu=moved(described, _off(generator, 0.03, 0.004)),
        time_offset=float(generator.uniform(-0.008, 0.008)),
        gravity_in_target=gravity_before(generator.uniform(-0.05, 0.05, 3)),
        biases=np.stack([generator.normal(0.0, 0.004, 3), generator.normal(0.0, 0.03, 3)]),
    )


def record_waved(
    path: Path, robot: RobotDescription, seed: int, seconds: float, progress: Callable[[int], object] = lambda _: None
) -> RigTruth:
    """Write a recording of `robot` before GRID; what is true of it. `progress` hears of every pair."""
    generator = np.random.default_rng([seed, 40])
    truth = built_askew(robot, generator)
    motion = HandHeldMotion(GRID, DISTANCE, generator)
    made = TargetRecording(truth, GRID, motion, robot.imu, generator, seconds=seconds, rate=robot.camera.rate)
    writer = RecordingWriter(path, robot_id="sim-1", robot=robot, clock=SimulatedClock(), started="made up")
    ticks = felt_ticks(made.inertia, robot)
    told = 0
    for sequence, (stamp_ns, (left, right)) in enumerate(made):
        while told < len(ticks) and ticks[told].stamp_ns <= stamp_ns:
            writer.write(topics.PROPRIOCEPTION.key, ticks[told])
            told += 1
        frame = StereoFrame(stamp_ns=stamp_ns, sequence=sequence, left=left, right=right)
        writer.write(topics.STEREO.key, frame)
        progress(1)
    for tick in ticks[told:]:
        writer.write(topics.PROPRIOCEPTION.key, tick)
    writer.close()
    return truth


def felt_ticks(samples: ImuBatch, robot: RobotDescription) -> list[Proprioception]:
    """Samples at instants as a robot that does nothing else tells them: by ticks, as means up to their stamps."""
    stamps = samples.stamp_ns + round(0.5e9 / robot.imu.rate)
    ends = np.searchsorted(stamps, np.arange(stamps[0], stamps[-1], TICK_NS) + TICK_NS // 2, side="right")
    joints = np.zeros(robot.joint_count)
    return [
        Proprioception(
            stamp_ns=int(stamps[end - 1]),
            joint_position=joints,
            joint_velocity=joints,
            joint_torque=joints,
            joint_valid=np.ones(robot.joint_count, dtype=np.bool_),
            joint_temperature=joints + 25.0,
            foot_contact=np.zeros(robot.leg_count, dtype=np.bool_),
            imu=ImuBatch(
                stamp_ns=stamps[begin:end],
                angular_velocity_in_imu=samples.angular_velocity_in_imu[begin:end],
                specific_force_in_imu=samples.specific_force_in_imu[begin:end],
            ),
            battery_voltage=25.0,
            supply_current=0.5,
            motor_power=0.0,
        )
        for begin, end in zip([0, *ends[:-1]], ends, strict=True)
        if end > begin
    ]


def _off(generator: np.random.Generator, turn: float, shift: float) -> np.ndarray:
    """A small motion (6,), up to so many rad and m about and along each axis."""
    return np.concatenate([generator.uniform(-turn, turn, 3), generator.uniform(-shift, shift, 3)])
