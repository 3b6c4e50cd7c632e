"""Recordings of a robot that was never there: some seconds of stamps, inertia and small noisy pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from robot_agent.recording import RecordingWriter
from weaver_shared import topics
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Heartbeat, ImuBatch, LeaseState, Proprioception, StereoFrame
from weaver_shared.robots import load_robot

ROBOT = load_robot()
ROBOT_ID = "sim-1"
TICK_NS = 10_000_000


def begun(path: Path, clock: SimulatedClock, *, pictures: bool = True) -> RecordingWriter:
    return RecordingWriter(
        path, robot_id=ROBOT_ID, robot=ROBOT, clock=clock, started="2026-01-02T03:04:05+00:00", pictures=pictures
    )


def heartbeat(stamp_ns: int) -> Heartbeat:
    return Heartbeat(stamp_ns=stamp_ns, sequence=stamp_ns // TICK_NS, session="a")


def lease(epoch: int) -> LeaseState:
    return LeaseState(holder="somebody", epoch=epoch, seconds_left=1.5)


def pair(stamp_ns: int, generator: np.random.Generator, shape: tuple[int, int] = (24, 32)) -> StereoFrame:
    left, right = generator.integers(0, 256, (2, *shape), dtype=np.uint8)
    return StereoFrame(stamp_ns=stamp_ns, sequence=stamp_ns // (5 * TICK_NS), left=left, right=right)


def felt(stamp_ns: int, generator: np.random.Generator) -> Proprioception:
    joints = ROBOT.joint_count
    return Proprioception(
        stamp_ns=stamp_ns,
        joint_position=generator.normal(size=joints),
        joint_velocity=np.zeros(joints),
        joint_torque=np.zeros(joints),
        joint_valid=np.ones(joints, dtype=np.bool_),
        joint_temperature=np.full(joints, 30.0),
        foot_contact=np.ones(ROBOT.leg_count, dtype=np.bool_),
        imu=ImuBatch(
            stamp_ns=np.array([stamp_ns - TICK_NS // 2, stamp_ns], dtype=np.int64),
            angular_velocity_in_imu=generator.normal(size=(2, 3)),
            specific_force_in_imu=generator.normal(size=(2, 3)),
        ),
        battery_voltage=25.0,
        supply_current=1.0,
        motor_power=20.0,
    )


def write(path: Path, *, seconds: float = 4.0, pictures: bool = True) -> tuple[list[tuple[int, int]], list[int]]:
    """A recording; the bytes on the disk at each robot time (ns), and the stamps of what the body felt."""
    clock = SimulatedClock()
    generator = np.random.default_rng(1)
    writer = begun(path, clock, pictures=pictures)
    on_disk: list[tuple[int, int]] = []
    stamps = []
    for tick in range(1, round(seconds * 100) + 1):
        clock.sleep_until(tick * TICK_NS)
        if tick == 1:
            writer.write(topics.LEASE.key, lease(1))
        writer.write(topics.PROPRIOCEPTION.key, felt(clock.now_ns(), generator))
        stamps.append(clock.now_ns())
        if pictures and tick % 5 == 0:
            writer.write(topics.STEREO.key, pair(clock.now_ns(), generator))
        writer.keep_safe()
        on_disk.append((clock.now_ns(), path.stat().st_size))
    writer.close()
    return on_disk, stamps
