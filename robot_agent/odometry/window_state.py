"""The arrays of the sliding window, one slot a frame, oldest first. Poses are those of the IMU in world."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.rotations import exponential, logarithm, orthonormal

Array = NDArray[np.float64]

STATE = 15
"""Unknowns of a frame: rotation (in imu), position, velocity (in world), gyro bias, accelerometer bias."""
ROTATION, POSITION, VELOCITY, GYRO_BIAS, ACCEL_BIAS = 0, 3, 6, 9, 12


class Frames(NamedTuple):
    rotation: Array  # (slots, 3, 3) world_from_imu
    position: Array  # (slots, 3) of the IMU in world
    velocity: Array  # (slots, 3) in world
    gyro_bias: Array  # (slots, 3)
    accel_bias: Array  # (slots, 3)
    rate: Array  # (slots, 3) angular velocity in imu at the frame, bias removed
    time_offset: Array  # (1,) s added to a picture's stamp for the IMU's time

    @staticmethod
    def of(slots: int) -> Frames:
        return Frames(
            rotation=np.tile(np.eye(3), (slots, 1, 1)),
            position=np.zeros((slots, 3)),
            velocity=np.zeros((slots, 3)),
            gyro_bias=np.zeros((slots, 3)),
            accel_bias=np.zeros((slots, 3)),
            rate=np.zeros((slots, 3)),
            time_offset=np.zeros(1),
        )

    def remove(self, slot: int) -> None:
        """Close the gap that `slot` leaves."""
        for array in self[:-1]:
            array[slot:-1] = array[slot + 1 :].copy()


@compiled
def unknowns(count: int) -> int:
    """Size of the system of `count` frames: their states and the time offset, which is the last unknown."""
    return STATE * count + 1


@compiled
def copy_slot(source: Frames, target: Frames, slot: int) -> None:
    target.rotation[slot] = source.rotation[slot]
    target.position[slot] = source.position[slot]
    target.velocity[slot] = source.velocity[slot]
    target.gyro_bias[slot] = source.gyro_bias[slot]
    target.accel_bias[slot] = source.accel_bias[slot]


@compiled
def advance(frames: Frames, count: int, step: Array) -> None:
    """Add a step (unknowns,) to the states: rotation on the right, everything else as vectors."""
    for k in range(count):
        d = step[STATE * k : STATE * (k + 1)]
        frames.rotation[k] = orthonormal(frames.rotation[k] @ exponential(d[ROTATION:POSITION]))
        frames.position[k] += d[POSITION:VELOCITY]
        frames.velocity[k] += d[VELOCITY:GYRO_BIAS]
        frames.gyro_bias[k] += d[GYRO_BIAS:ACCEL_BIAS]
        frames.accel_bias[k] += d[ACCEL_BIAS:]
    frames.time_offset[0] += step[STATE * count]


@compiled
def difference(frames: Frames, origin: Frames, count: int) -> Array:
    """The step (unknowns,) that leads from `origin` to `frames`."""
    step = np.zeros(unknowns(count))
    for k in range(count):
        d = step[STATE * k : STATE * (k + 1)]
        d[ROTATION:POSITION] = logarithm(np.ascontiguousarray(origin.rotation[k].T) @ frames.rotation[k])
        d[POSITION:VELOCITY] = frames.position[k] - origin.position[k]
        d[VELOCITY:GYRO_BIAS] = frames.velocity[k] - origin.velocity[k]
        d[GYRO_BIAS:ACCEL_BIAS] = frames.gyro_bias[k] - origin.gyro_bias[k]
        d[ACCEL_BIAS:] = frames.accel_bias[k] - origin.accel_bias[k]
    step[STATE * count] = frames.time_offset[0] - origin.time_offset[0]
    return step
